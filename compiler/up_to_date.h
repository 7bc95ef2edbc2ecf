// Whether a package is up to date.
#pragma once
#include "compiler/compile.h"

/// The provenance that a package stores.
struct PackageOrigin
{
    lumicut::fb::ProvenanceT provenance;
    uint64_t hash = 0; // of the header, and by way of it of the whole package
};

/// Of a package that was just written. @return 0 where it cannot be read
uint64_t packageHash(const std::filesystem::path& package);

/// Reads and hashes all of `package`, but does not verify its contents. @return nothing if it is damaged or missing
std::optional<PackageOrigin> readOrigin(const std::filesystem::path& package);

/// Whether `options.output` is what compile() would write: made by a compiler of the same sources, with the same
/// `options.text`, from files with unchanged content. Files that were missing must still be missing.
bool isUpToDate(const CompileOptions& options, const PackageOrigin& origin);

/// Every file that a package was made from, or that was looked for, as paths relative to the working directory: the scene,
/// the files it names, the environment.
std::vector<std::filesystem::path> inputPaths(const CompileOptions& options,
                                              const lumicut::fb::ProvenanceT& provenance);
