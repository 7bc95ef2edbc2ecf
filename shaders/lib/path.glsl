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
bool geometryAgrees(Surface s, vec3 wi, float local_z)
{
    return dot(s.geometric_normal, wi) * local_z > 0.0;
}

/// So must they where light is looked for. From a point on the smooth surface above the triangle a ray may also go where the
/// triangle faces away: whether it gets out there is for the ray to find.
bool sidesAgree(Surface s, vec3 wi, float local_z)
{
    return geometryAgrees(s, wi, local_z) || (s.lifted && local_z > 0.0 && dot(s.smooth_normal, wi) > 0.0);
}

/// The ray that leaves s along wi: off the surface by more than rounding, to the side from where wi was looked for.
Ray leavingRay(Surface s, vec3 wi, float t_max, uint path)
{
    bool above = dot(s.geometric_normal, wi) >= 0.0 || (s.lifted && dot(s.smooth_normal, wi) > 0.0);
    float height = -s.back * dot(s.geometric_normal, s.direction);
    vec3 origin = s.position;
    if (above)
        origin += max(0.0, s.error - height) * s.geometric_normal - s.back * s.direction;
    else
        origin -= s.error * s.geometric_normal;
    return Ray(origin, t_max, wi, path);
}

/// The ray that decides whether s sees the light. It ends there: traversal lets pass what the light lies on.
Ray shadowRay(Surface s, LightSample light, uint path)
{
    Ray ray = leavingRay(s, light.wi, kInfinity, path);
    if (light.distance >= kInfinity)
        return ray;
    vec3 to_light = light.position - ray.origin;
    ray.t_max = length(to_light);
    ray.direction = ray.t_max > 0.0 ? to_light / ray.t_max : light.wi;
    return ray;
}

#endif
