// Cameras besides those of the file.
#pragma once
#include "compiler/flatten.h"
#include "compiler/scene_data.h"
#include "format/result.h"

/// Parses NAME=EX,EY,EZ,TX,TY,TZ,YFOV: eye and target in metres of the file, vertical field of view in degrees.
Result<CameraView> parseView(const std::string& text);

/// A three-quarter view that frames the box, named "default".
CameraView defaultView(const Bounds& box);

/// Numbers separated by commas, exactly `count` of them, all finite.
Result<std::vector<double>> parseNumbers(const std::string& text, size_t count);
