// Cameras: from a place in the picture to a ray, and back. Functions only.
#ifndef LIB_VIEW_GLSL
#define LIB_VIEW_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/primary/primary.h"

/// The ray through place `at` of the picture, in pixels from its upper left corner, from the near plane to the far one.
Ray cameraRay(CameraParams camera, vec2 at, uint path)
{
    vec2 image = vec2(2.0, -2.0) * at / vec2(camera.width, camera.height) + vec2(-1.0, 1.0);
    vec3 offset = image.x * camera.right + image.y * camera.up;
    Ray ray = Ray(camera.position, kInfinity, camera.forward, path);
    float per_depth = 1.0; // metres along the ray for one along forward
    if (camera.orthographic != 0u)
        ray.origin += offset;
    else
    {
        per_depth = length(camera.forward + offset);
        ray.direction = normalize(camera.forward + offset);
    }
    ray.origin += camera.near_plane * per_depth * ray.direction;
    if (camera.far_plane > 0.0)
        ray.t_max = (camera.far_plane - camera.near_plane) * per_depth;
    return ray;
}

/// The ray of a pixel: through a place of its own (box filter), the same for all pixels where the camera is jittered.
/// @param sample_ of the dispatch, of sample_count
Ray pixelRay(CameraParams camera, uint pixel, uint sample_)
{
    uint row = quotient(pixel, camera.width), column = pixel - row * camera.width;
    Sampler s = Sampler(hash(camera.seed, pixel), camera.first_sample + sample_, 0u);
    vec2 within = camera.jitter.x > 0.0 ? camera.jitter : nextPair(s);
    return cameraRay(camera, vec2(column, row) + within, sample_ * camera.width * camera.height + pixel);
}

/// Metres from the eye, or the plane through it, to where its ray starts.
float nearDistance(CameraParams camera, Ray ray)
{
    return camera.near_plane / (camera.orthographic != 0u ? 1.0 : dot(ray.direction, camera.forward));
}

vec2 picturePlace(CameraParams camera, vec2 image)
{
    return (vec2(0.5, -0.5) * image + 0.5) * vec2(camera.width, camera.height);
}

/// Where in the picture, in pixels, a direction from far away is. @return false where it is behind the camera
bool imageDirection(CameraParams camera, vec3 direction, out vec2 at)
{
    at = vec2(0.0);
    float depth = dot(direction, camera.forward);
    if (camera.orthographic != 0u || !(depth > 0.0))
        return false;
    vec2 image = vec2(dot(direction, camera.right) / dot(camera.right, camera.right), dot(direction, camera.up) / dot(camera.up, camera.up));
    at = picturePlace(camera, image / depth);
    return true;
}

/// The same of a point.
bool imagePosition(CameraParams camera, vec3 point, out vec2 at)
{
    vec3 d = point - camera.position;
    if (camera.orthographic == 0u)
        return imageDirection(camera, d, at);
    at = picturePlace(camera, vec2(dot(d, camera.right) / dot(camera.right, camera.right), dot(d, camera.up) / dot(camera.up, camera.up)));
    return true;
}

#endif
