// How cameras and lights move in measurements.
#pragma once
#include "runtime/camera.h"

/// The given view swaying: 5 degrees to either side, the eye on a circle of 1/400 of the scene's diagonal, 120 frames a
/// round; no two successive frames see the same. At frame 0 it is the given view.
Camera movedCamera(const Camera& camera, const gpu::SceneInfo& info, int32_t frame);

/// Directional: turned one degree a frame about the vertical, or about x where it shines straight down. Else moved on a
/// circle of 1/200 of the scene's diagonal, three degrees a frame.
gpu::Light movedLight(const gpu::Light& light, const gpu::SceneInfo& info, int32_t frame);
