// Reads OpenEXR pictures.
#pragma once
#include "image/image.h"
#include "image/picture.h"

#include <cstddef>
#include <filesystem>

/// Reads the display window of the first part that has colour: what lies outside the data window is black, what lies
/// outside the display window is left out. Of a cube map (attribute "envmap") it is the data window. Channels R, G, B,
/// or Y, RY, BY, or Y alone for grey, of no layer or else of the first that has them; half, float or uint, sub-sampled
/// or not; scan lines or level 0 of tiles; any compression. Chromaticities are converted to Rec. 709. Memory: a strip
/// of the picture (a row of tiles; all of a sub-sampled picture) and what `sink` takes.
/// @return kInvalid where it is not a whole OpenEXR file or has no colour, kUnsupported for deep pixels, other kinds of
/// environment maps and sizes above kMaxPicturePixels, kDevice where memory runs out
Status readExr(std::span<const std::byte> file, PictureSink& sink);

/// The same, of a file of at most 2^28 pixels, into memory. kIo where it cannot be opened.
Result<ImageF> readExr(const std::filesystem::path& path);
