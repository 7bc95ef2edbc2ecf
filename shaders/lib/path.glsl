// Steps that every path shares: frames at a vertex, absorption, the choice of sampler dimensions. Functions only.
#ifndef LIB_PATH_GLSL
#define LIB_PATH_GLSL
#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/lights.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/lib/shading_point.glsl"

/// The sampler of a path at its vertex number `depth`.
Sampler vertexSampler(uint path, uint depth, uint pixel_count, uint first_sample, uint seed)
{
    uint sample_ = path / pixel_count; // one division: software Vulkan makes them one by one
    return Sampler(hash(seed, path - sample_ * pixel_count), first_sample + sample_, kCameraDimensions + depth * kVertexDimensions);
}

/// What an absorbing medium leaves of light over `distance` metres (Beer-Lambert).
vec3 mediumTransmittance(uint medium, float distance)
{
    return !hasFeature(kFeatureTransmission) || medium == kNone ? vec3(1.0) : exp(-loadMaterial(medium).absorption * distance);
}

bool enclosesMedium(Surface s, SurfaceMaterial m)
{
    return hasFeature(kFeatureTransmission) && m.transmission > 0.0 && (m.flags & kMaterialThin) == 0u;
}

/// The medium a ray crossed to reach s: the one its path entered, or, when it started inside, that of s itself.
uint crossedMedium(uint medium, Surface s, SurfaceMaterial m)
{
    return medium == kNone && !s.front && enclosesMedium(s, m) ? s.material : medium;
}

/// A direction and the geometry must agree on which side it leaves: shading normals alone would leak light.
bool sidesAgree(Surface s, vec3 wi, float local_z)
{
    return dot(s.geometric_normal, wi) * local_z > 0.0;
}

/// The ray that leaves s along wi.
Ray leavingRay(Surface s, vec3 wi, float t_max, uint path)
{
    vec3 side = dot(s.geometric_normal, wi) >= 0.0 ? s.geometric_normal : -s.geometric_normal;
    return Ray(offsetOrigin(s.position, side), t_max, wi, path);
}

/// A shadow ray stops short of its light by this much of the distance: a punctual light may lie on a surface.
const float kShadowShortening = 1.0 - 1e-4;

/// The ray that decides whether s sees the light. It leaves one surface and stops short of the other by as much as
/// rounding needs, measured from where it really starts: the distance from s itself would carry it into a near light.
Ray shadowRay(Surface s, LightSample light, uint path)
{
    Ray ray = leavingRay(s, light.wi, kInfinity, path);
    if (light.distance >= kInfinity)
        return ray;
    vec3 to_light = light.position - ray.origin;
    float distance = length(to_light);
    ray.t_max = distance * kShadowShortening;
    ray.direction = to_light / max(distance, 1e-20);
    return ray;
}

#endif
