// Where what a pixel shows was in the last picture. The kernel declares `readonly buffer Views` and `readonly buffer LastCorners`
// before it includes this. Functions only.
#ifndef LIB_MOTION_GLSL
#define LIB_MOTION_GLSL
#include "shaders/lib/view.glsl"
#include "shaders/pose/pose.h"
#include "shaders/signals/signals.h"

/// How far a surface has come since the last frame, metres.
vec3 displacementOf(ShadingPoint point)
{
    if (point.slot == kNone || point.slot < scene.first_moving_slot)
        return vec3(0.0);
    TriangleCorners last = last_corners[point.slot - scene.first_moving_slot];
    BvhTriangle now = loadBvhTriangle(point.slot);
    vec3 weights = vec3(1.0 - point.barycentrics.x - point.barycentrics.y, point.barycentrics);
    return weights.x * (now.v0 - last.v0) + weights.y * (now.v1 - last.v1) + weights.z * (now.v2 - last.v2);
}

/// A way in the world as it is seen in the point's mirror. Behind several mirrors it is taken as it is.
vec3 wayInMirror(ShadingPoint point, vec3 way)
{
    bool one = point.depth > 0u && point.mirror != kNoMirror && point.mirror != kManyMirrors;
    return one ? reflect(way, unpackNormal(point.mirror)) : way;
}

/// Where what the pixel shows was in the last picture. In mirrors and glass it is taken for the image behind them that a plane
/// one would show, if that stands still. @param spread of ShadingPoint.width over the way from the eye
Motion motionOf(uint pixel, ShadingPoint point, vec3 displacement, float spread, bool has_last)
{
    CameraParams camera = views.now;
    uint row = quotient(pixel, camera.width);
    vec2 at = vec2(pixel - row * camera.width, row) + (camera.jitter.x > 0.0 ? camera.jitter : vec2(0.5));
    Ray ray = cameraRay(camera, at, pixel);
    float distance_ = kInfinity;
    if (point.slot != kNone)
        distance_ = point.depth == 0u || spread == 0.0 ? dot(point.position - ray.origin, ray.direction) + nearDistance(camera, ray)
                                                               : point.width / spread;
    if (!has_last)
        return Motion(vec2(kNoMotion), distance_);
    vec3 eye = ray.origin - nearDistance(camera, ray) * ray.direction;
    vec2 last;
    bool seen = distance_ < kInfinity ? imagePosition(views.last, eye + distance_ * ray.direction - wayInMirror(point, displacement), last)
                                      : imageDirection(views.last, ray.direction, last);
    return Motion(seen ? last - at : vec2(kNoMotion), distance_);
}

#endif
