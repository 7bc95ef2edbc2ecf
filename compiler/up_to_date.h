// Whether a package has to be made at all.
#pragma once
#include "compiler/compile.h"

/// What a package says of how it was made.
struct PackageOrigin
{
    lumicut::fb::ProvenanceT provenance;
    uint64_t hash = 0; // of the header, and by way of it of the whole package
};

/// Of a package that was just written. @return 0 where it cannot be read
uint64_t packageHash(const std::filesystem::path& package);

/// Reads and hashes all of `package`, but does not verify what is in it. @return nothing where it is damaged or missing
std::optional<PackageOrigin> readOrigin(const std::filesystem::path& package);

/// Whether `options.output` is what compile() would write: made by a compiler of the same sources, with the same
/// `options.text`, from files that still hold the same. Files that were missing must be missing still.
bool isUpToDate(const CompileOptions& options, const PackageOrigin& origin);

/// Every file that a package was made from or asked for, as paths that hold from here: the scene, what it names, the
/// environment.
std::vector<std::filesystem::path> inputPaths(const CompileOptions& options,
                                              const lumicut::fb::ProvenanceT& provenance);
