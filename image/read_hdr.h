// Reads Radiance pictures (.hdr, .pic).
#pragma once
#include "image/picture.h"

#include <cstddef>

/// Reads a Radiance picture: flat, old and new run lengths, every orientation, RGBE and XYZE. EXPOSURE and COLORCORR
/// lines are divided out, PRIMARIES converted to Rec. 709. (Ward, "Real Pixels", Graphics Gems II; Radiance's File
/// Formats.) Memory: one line and what `sink` takes.
/// @return kInvalid where the file is damaged, cut off or no Radiance picture, kUnsupported above kMaxPicturePixels
Status readHdr(std::span<const std::byte> file, PictureSink& sink);
