// OpenEXR in.
#pragma once
#include "format/result.h"
#include "tools/image/image.h"

#include <filesystem>

/// Reads the data window of the first part: channels R, G, B, or Y alone for grey; half, float or uint; any
/// compression; other channels are ignored. Errors: kIo where the file cannot be opened, kInvalid where it is not a
/// whole OpenEXR file, kUnsupported for channels or sizes we do not read (luminance-chroma, sub-sampled, deep, above
/// 2^28 pixels).
Result<ImageF> readExr(const std::filesystem::path& path);
