// Steps common to all paths: the surface at a vertex, absorption, the ray that leaves, the choice of sampler dimensions.
// Functions only.
#ifndef LIB_PATH_GLSL
#define LIB_PATH_GLSL
#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/finish.glsl"
#include "shaders/lib/lights.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/lib/shading_point.glsl"

/// The sampler of a path at its vertex number `depth`.
Sampler vertexSampler(uint path, uint depth, uint pixel_count, uint first_sample, uint seed)
{
    uint sample_ = quotient(path, pixel_count);
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

struct PathVertex // where a path meets matter
{
    Surface surface;
    SurfaceMaterial material;
    Bsdf bsdf;
    mat3 frame; // from local to world: z along the shading normal, x along the grain of an anisotropic surface
    vec3 wo;    // local, towards where the path came from
};

/// x along the grain where the material has one, else anywhere across the normal.
mat3 shadingFrame(Surface s, SurfaceMaterial m)
{
    if (hasFeature(kFeatureAnisotropy) && m.anisotropy > 0.0)
    {
        vec3 along = m.grain.x * s.tangent + m.grain.y * s.bitangent;
        along -= s.normal * dot(s.normal, along);
        if (dot(along, along) > 1e-8)
        {
            along = normalize(along);
            return mat3(along, cross(s.normal, along), s.normal);
        }
    }
    return frameAround(s.normal);
}

PathVertex vertexAt(Surface s, SurfaceMaterial m)
{
    PathVertex v;
    v.surface = s;
    v.material = m;
    v.frame = shadingFrame(s, v.material);
    v.wo = -s.direction * v.frame;
    vec3 clearcoat_normal = vec3(0.0, 0.0, 1.0);
    if (hasFeature(kFeatureClearcoat) && v.material.clearcoat > 0.0)
        clearcoat_normal = clearcoatNormal(s) * v.frame;
    v.bsdf = bsdfAt(v.material, s.front, clearcoat_normal);
    return v;
}
PathVertex vertexAt(Surface s) { return vertexAt(s, materialAt(s)); }
/// @param width metres, of the ray where it ends
PathVertex vertexAt(Ray ray, Hit hit, float width) { return vertexAt(surfaceAt(ray, hit, width)); }
PathVertex vertexAt(Ray ray, Hit hit) { return vertexAt(surfaceAt(ray, hit)); }
PathVertex vertexAt(ShadingPoint point)
{
    Surface s = surfaceAt(point);
    vec2 finish = unpackFinish(point.finish);
    return vertexAt(s, materialAt(s, point.base_color, finish.y, finish.x));
}

bool isUnlit(PathVertex v) { return (v.material.flags & kMaterialUnlit) != 0u; }

/// What the medium leaves of light over the ray's way to the vertex. @param medium that the path is in
vec3 transmittanceTo(PathVertex v, uint medium, float distance)
{
    return mediumTransmittance(crossedMedium(medium, v.surface, v.material), distance);
}

/// The medium a path is in after it went on from the vertex.
uint mediumAfter(PathVertex v, BsdfSample next, uint medium)
{
    if (next.wi.z >= 0.0 || next.passed)
        return medium;
    return v.surface.front && enclosesMedium(v.surface, v.material) ? v.surface.material : kNone;
}

/// The number by which a vertex picks a channel: a pair that neither lights nor lobes use (kVertexDimensions).
float dispersionDraw(Sampler s)
{
    s.dimension += kLightPairs + 2u;
    return nextPair(s).x;
}

/// Where a material disperses light, the path continues for a single channel: the one that it represents already, else one picked
/// in proportion to `carried`. Only refracted light is concerned.
/// @param carried throughput or power; @param random in [0, 1)
void disperse(inout PathVertex v, vec3 carried, float random)
{
    if (!hasFeature(kFeatureDispersion) || v.material.dispersion == 0.0 || v.bsdf.thin || v.bsdf.transmission == 0.0)
        return;
    vec3 share = abs(carried) / max(dot(abs(carried), vec3(1.0)), 1e-30);
    uint channel = random < share.x ? 0u : random < share.x + share.y || share.z == 0.0 ? 1u : 2u;
    // Indices of red, green and blue (KHR_materials_dispersion): 20 / V = dispersion, the spread is (n - 1) / V.
    float spread = 0.5 * (v.material.ior - 1.0) * 0.05 * v.material.dispersion;
    float ior = max(v.material.ior + spread * (float(channel) - 1.0), 1.0);
    v.bsdf.eta = v.surface.front ? ior : 1.0 / ior;
    v.bsdf.dispersed = vec3(0.0);
    v.bsdf.dispersed[channel] = 1.0 / max(share[channel], 1e-30);
}

/// A direction and the geometry must agree on which side it leaves: shading normals alone would leak light.
bool geometryAgrees(Surface s, vec3 wi, float local_z)
{
    return dot(s.geometric_normal, wi) * local_z > 0.0;
}

/// The same for light sampling. From a point on the smooth surface above the triangle a ray may also go where the triangle faces
/// away: the ray itself tests whether it is occluded there.
bool sidesAgree(Surface s, vec3 wi, float local_z)
{
    return geometryAgrees(s, wi, local_z) || (s.lifted && local_z > 0.0 && dot(s.smooth_normal, wi) > 0.0);
}

/// The ray that leaves s along wi: off the surface by more than rounding, to the side that wi was sampled on.
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

/// The shadow ray from s to the light. It ends there: traversal ignores the surface on which the light lies.
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
