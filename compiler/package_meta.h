// What the compiler made as the package has it: META, and the chunks of geometry.
#pragma once
#include "compiler/build_bvh.h"
#include "compiler/build_lights.h"
#include "compiler/compile.h"
#include "compiler/environment.h"
#include "compiler/input_files.h"
#include "compiler/texture_pages.h"
#include "format/fold_geometry.h"

/// @param importance null without environment
lumicut::fb::MetaT makeMeta(const CompileOptions& options, const SceneData& scene, const Bvh& bvh,
                            const LightTables& lights, const TexturePages& textures,
                            const EnvironmentImportance* importance);

/// Notes what the package is made from, for isUpToDate().
void noteInputs(const std::vector<InputFile>& files, const std::optional<ContentHash>& environment,
                lumicut::fb::ProvenanceT& provenance);

/// The META chunk's bytes.
std::vector<uint8_t> encodeMeta(const lumicut::fb::MetaT& meta);

/// The MOTN chunk's bytes, with lights as LITE numbers them.
/// @return kUnsupported where there is too much for a reader
Result<std::vector<uint8_t>> encodeMotion(const SceneData& scene, const LightTables& lights);

/// The mesh and its hierarchy; refers to the mesh's positions.
package::StoredGeometry foldGeometry(const WorldMesh& mesh, const Bvh& bvh);
