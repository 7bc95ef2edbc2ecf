// Where the camera is in each frame of a measurement.
#pragma once
#include "tools/bench/geometry.h"
#include "tools/bench/opened.h"

#include <functional>

/// Frames before the first are negative.
using CameraOfFrame = std::function<Camera(int32_t frame)>;

/// @param path "sway": movedCamera(), "orbit": orbitingCamera() of orbitRadius(), else a file that CameraPath::load()
/// reads, whose first key is frame 0; before it the camera comes backwards along the path
/// @param opened whose camera sways or orbits; borrowed
/// @return kInvalid where the camera to orbit sees nothing, and what CameraPath::load() returns
Result<CameraOfFrame> chooseMotion(const std::string& path, double frames_per_second, const OpenedPackage& opened,
                                   const Geometry& geometry);
