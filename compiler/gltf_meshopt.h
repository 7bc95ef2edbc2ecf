// Decodes EXT_meshopt_compression, and KHR_meshopt_compression where it holds streams of the same version.
#pragma once
#include "compiler/warnings.h"
#include "format/result.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <vector>

enum class MeshoptMode
{
    kAttributes,
    kTriangles,
    kIndices,
};

enum class MeshoptFilter
{
    kNone,
    kOctahedral,
    kQuaternion,
    kExponential,
    kColor, // of KHR_meshopt_compression; cannot be decoded
};

/// A buffer view whose content is there as a compressed stream. Count and stride suit mode and filter, and decoding
/// gives as many bytes as the view has.
struct MeshoptView
{
    size_t view = 0;   // buffer view that it stands for
    size_t buffer = 0; // where the stream lies; unchecked, as offset and bytes are
    size_t offset = 0;
    size_t bytes = 0;
    size_t count = 0;  // elements
    size_t stride = 0; // bytes an element
    MeshoptMode mode = MeshoptMode::kAttributes;
    MeshoptFilter filter = MeshoptFilter::kNone;
};

/// No stream is smaller than its content by more than this factor: every 64 bytes of it need one at least.
constexpr size_t kMeshoptMostRatio = 64;

/// The compressed buffer views of a file, but for those that are described wrongly, with a warning for each.
std::vector<MeshoptView> findMeshoptViews(const nlohmann::json& document, Warnings& warnings);

/// The content of `view`, count * stride bytes, from `buffer`, which is the one that it names.
/// @return kInvalid for damaged streams, kUnsupported for a newer version of the codec or a filter of it
Result<std::vector<unsigned char>> decodeMeshopt(const MeshoptView& view, const std::vector<unsigned char>& buffer);
