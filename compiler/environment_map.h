// Environment maps from files: reading .exr and .hdr into an equirectangular map of bounded size.
#pragma once
#include "compiler/scene_data.h"
#include "image/picture.h"

#include <filesystem>

/// The largest map that is written, in texels: 512 MiB. Larger pictures are averaged.
inline constexpr uint32_t kMaxEnvironmentWidth = 8192;
inline constexpr uint32_t kMaxEnvironmentHeight = 4096;

struct LoadedEnvironment
{
    EnvironmentImage image;
    std::vector<std::string> warnings; // sentences that name the file
};

/// Reads a map and multiplies it by `scale` > 0. Invalid values are replaced and counted in a warning: NaN and negative
/// radiance by 0, infinite radiance by 65504, the largest half. A picture larger than the limits is averaged over solid
/// angle, which preserves its power. A cube map is resampled to an equirectangular one.
/// Memory: 16 bytes a texel of the map, in addition as much a pixel of a cube.
/// @return the readers' errors (image/read_exr.h, image/read_hdr.h), about `path`; kUnsupported for other suffixes
Result<LoadedEnvironment> loadEnvironment(const std::filesystem::path& path, float scale = 1);

/// The same of a file's bytes; `name` is what warnings call it.
Result<LoadedEnvironment> decodeExrEnvironment(std::span<const std::byte> file, const std::string& name,
                                               float scale = 1);
Result<LoadedEnvironment> decodeHdrEnvironment(std::span<const std::byte> file, const std::string& name,
                                               float scale = 1);
