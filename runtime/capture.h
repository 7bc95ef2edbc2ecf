// Pictures out of the player.
#pragma once
#include "runtime/renderer.h"

#include <filesystem>

/// Whether `path` ends in a picture format the player writes. @return kUsage naming the formats
Status checkPicturePath(const std::filesystem::path& path);

/// Writes the picture so far: .exr linear radiance, 32-bit; .png exposed and tone-mapped.
Status capture(const std::filesystem::path& path, Renderer& renderer, const Device& device, const SceneGpu& scene,
               const Settings& settings);
