// How cameras and lights move in measurements.
#pragma once
#include "runtime/camera.h"

/// The given view swaying: 5 degrees to either side, the eye on a circle of 1/400 of the scene's diagonal, 120 frames a
/// round; no two successive frames are the same. At frame 0 it is the given view.
Camera movedCamera(const Camera& camera, const gpu::SceneInfo& info, float frame);

/// The given view walking around what lies |radius| metres before it, 20 degrees a second, always facing it; to the right
/// where the radius is positive. At 0 s it is the given view.
Camera orbitingCamera(const Camera& camera, float radius, float seconds);

/// For orbitingCamera(): half-way to what the camera looks at, nearer where there is less room beside it, to the side that
/// has more. Where it looks some 8 metres far that is walking speed, 1.4 m/s.
/// @param ahead, left, right metres to the first surface there; infinite where there is none
float orbitRadius(float ahead, float left, float right);

/// Directional: turned one degree a frame about the vertical, or about x where it shines straight down. Else moved on a
/// circle of 1/200 of the scene's diagonal, three degrees a frame.
gpu::Light movedLight(const gpu::Light& light, const gpu::SceneInfo& info, int32_t frame);
