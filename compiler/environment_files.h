// Readers of the two file types an environment map may have. Texels are as the file stores them, w unset.
#pragma once
#include "compiler/scene_data.h"
#include "format/result.h"

#include <filesystem>

inline constexpr int kMaxEnvironmentSide = 16384; // texels; what every GPU can sample

Result<EnvironmentImage> readExr(const std::filesystem::path& path);
Result<EnvironmentImage> readHdr(const std::filesystem::path& path);
