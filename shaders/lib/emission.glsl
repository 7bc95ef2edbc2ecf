// Emission of photons: positions and directions by each light's own distribution, or aimed at the scene's specular
// objects (Jensen 2001, "Realistic Image Synthesis Using Photon Mapping", 5.2 and 5.3). Functions only.
#ifndef LIB_EMISSION_GLSL
#define LIB_EMISSION_GLSL
#include "shaders/lib/lights.glsl"

layout(set = 0, binding = kCausticTargetsBinding, scalar) readonly buffer CausticTargets { CausticTarget caustic_targets[]; };

struct Emission
{
    vec3 origin;
    vec3 direction; // unit
    vec3 power;     // watts for one photon in all; 0: nothing leaves this way
};

const Emission kNoEmission = Emission(vec3(0.0), vec3(0.0, 0.0, 1.0), vec3(0.0));

vec3 uniformSphere(vec2 u)
{
    float z = 1.0 - 2.0 * u.x, r = sqrt(max(0.0, 1.0 - z * z)), phi = 2.0 * kPi * u.y;
    return vec3(r * cos(phi), r * sin(phi), z);
}

/// A direction within `height` = 1 - cos(half angle) of the z axis.
vec3 uniformCone(float height, vec2 u)
{
    float h = height * u.x, r = sqrt(max(0.0, h * (2.0 - h))), phi = 2.0 * kPi * u.y;
    return vec3(r * cos(phi), r * sin(phi), 1.0 - h);
}

/// Squares of u stay compact, so that learned cells are compact regions, not slices (Shirley & Chiu 1997).
vec2 uniformDisc(vec2 u)
{
    vec2 at = 2.0 * u - 1.0;
    bool wide = abs(at.x) > abs(at.y);
    float r = wide ? at.x : at.y;
    if (r == 0.0)
        return vec2(0.0);
    float phi = wide ? 0.25 * kPi * at.y / at.x : 0.5 * kPi - 0.25 * kPi * at.x / at.y;
    return r * vec2(cos(phi), sin(phi));
}

/// 1 - cos of the half angle under which a sphere is seen; 2, the whole sphere of directions, from within.
float coneHeight(CausticTarget target, vec3 origin)
{
    vec3 to_center = target.center - origin;
    float sin2 = square(target.radius) / dot(to_center, to_center);
    return sin2 >= 1.0 ? 2.0 : sin2 / (1.0 + sqrt(1.0 - sin2));
}

/// Density per steradian of directions aimed from `origin`, targets picked uniformly.
float aimedDirectionPdf(vec3 origin, vec3 direction)
{
    float pdf = 0.0;
    for (uint i = 0u; i < scene.caustic_target_count; ++i)
    {
        float height = coneHeight(caustic_targets[i], origin);
        bool inside = dot(direction, normalize(caustic_targets[i].center - origin)) >= 1.0 - height;
        pdf += inside ? 1.0 / (2.0 * kPi * height) : 0.0;
    }
    return pdf / float(scene.caustic_target_count);
}

/// Density per square metre of origins across a parallel beam, aimed at targets picked uniformly.
float aimedOriginPdf(vec3 origin, vec3 direction)
{
    float pdf = 0.0;
    for (uint i = 0u; i < scene.caustic_target_count; ++i)
    {
        vec3 off_axis = cross(caustic_targets[i].center - origin, direction);
        float radius2 = square(caustic_targets[i].radius);
        pdf += dot(off_axis, off_axis) <= radius2 ? 1.0 / (kPi * radius2) : 0.0;
    }
    return pdf / float(scene.caustic_target_count);
}

vec3 sceneCenter() { return 0.5 * (scene.bounds_min + scene.bounds_max); }
float sceneRadius() { return 0.5 * length(scene.bounds_max - scene.bounds_min) * 1.0001; }

/// Photons of a beam start no farther from the place that they are aimed at than this many times what that is from the viewer: the
/// rounding of their start is then a thousandth of it. Geometry beyond casts no shadow on them. 2^14 * 2^-24 = 1/1024.
const float kFarthestStart = 16384.0;

/// The start of a photon of a parallel beam through `place`: in front of the whole scene, as far as rounding allows.
vec3 beamStart(vec3 place, vec3 direction)
{
    float before = sceneRadius() - dot(sceneCenter() - place, direction);
    float farthest = kFarthestStart * (view_scale.distance + distance(place, view_scale.focus));
    return place - min(before, farthest) * direction;
}

/// Where along a parallel beam a photon starts, and the density of that per square metre.
vec3 infiniteOrigin(vec3 direction, float aim, bool aimed, uint target, vec2 u, out float pdf)
{
    vec3 center = aimed ? caustic_targets[target].center : sceneCenter();
    float radius = aimed ? caustic_targets[target].radius : sceneRadius();
    mat3 frame = frameAround(direction);
    vec2 disc = uniformDisc(u) * radius;
    vec3 place = center + frame * vec3(disc, 0.0);
    vec3 off_center = cross(sceneCenter() - place, direction);
    bool inside = dot(off_center, off_center) <= square(sceneRadius());
    pdf = inside ? (1.0 - aim) / (kPi * square(sceneRadius())) : 0.0;
    if (aim > 0.0)
        pdf += aim * aimedOriginPdf(place, direction);
    return beamStart(place, direction);
}

/// The same near the viewer more than elsewhere: density falls with the distance from the view's focus, each way, so that the
/// cells of a grid over u are equally important, whatever the size of the scene.
vec3 focusedOrigin(vec3 direction, vec2 u, out float pdf)
{
    mat3 frame = frameAround(direction);
    vec2 center = ((sceneCenter() - view_scale.focus) * frame).xy / view_scale.distance;
    float radius = sceneRadius() / view_scale.distance;
    vec2 low = asinh(center - radius), high = asinh(center + radius), t = mix(low, high, u);
    vec2 place = sinh(t) * view_scale.distance, stretch = cosh(t) * view_scale.distance * (high - low);
    pdf = 1.0 / (stretch.x * stretch.y);
    return beamStart(view_scale.focus + frame * vec3(place, 0.0), direction);
}

Emission emitPoint(Light light, float aim, bool aimed, uint target, vec2 u)
{
    float cos_outer = light.kind == kLightSpot ? -light.p2.y / light.p2.x : -1.0;
    float height = 1.0 - cos_outer;
    vec3 axis = light.kind == kLightSpot ? light.p1 : vec3(0.0, 0.0, 1.0);
    if (aimed)
        axis = normalize(caustic_targets[target].center - light.p0);
    vec3 direction = frameAround(axis) * uniformCone(aimed ? coneHeight(caustic_targets[target], light.p0) : height, u);
    vec3 intensity = light.emission;
    bool in_cone = true;
    if (light.kind == kLightSpot)
    {
        float cosine = dot(light.p1, direction);
        in_cone = cosine >= cos_outer;
        intensity *= square(clamp(cosine * light.p2.x + light.p2.y, 0.0, 1.0));
    }
    float pdf = in_cone ? (1.0 - aim) / (2.0 * kPi * height) : 0.0;
    if (aim > 0.0)
        pdf += aim * aimedDirectionPdf(light.p0, direction);
    return pdf > 0.0 ? Emission(light.p0, direction, intensity / (light.pmf * pdf)) : kNoEmission;
}

/// @param side below 0.5: a two-sided triangle emits from its front
Emission emitTriangle(Light light, float aim, bool aimed, uint target, vec2 u, vec2 v, float side)
{
    float r = sqrt(v.x);
    vec3 weights = vec3(1.0 - r, r * (1.0 - v.y), r * v.y);
    vec3 position = interpolate(weights, light.p0, light.p1, light.p2);
    vec3 twice_area = cross(light.p1 - light.p0, light.p2 - light.p0);
    float area = 0.5 * length(twice_area);
    bool two_sided = light.kind == kLightTriangleTwoSided;
    vec3 normal = normalize(twice_area) * (two_sided && side >= 0.5 ? -1.0 : 1.0);
    vec3 direction;
    if (aimed)
        direction = frameAround(normalize(caustic_targets[target].center - position)) *
                    uniformCone(coneHeight(caustic_targets[target], position), u);
    else
    {
        vec2 disc = uniformDisc(u);
        direction = frameAround(normal) * vec3(disc, sqrt(max(0.0, 1.0 - dot(disc, disc))));
    }
    float cosine = dot(direction, normal);
    if (aimed && two_sided)
    {
        normal *= cosine < 0.0 ? -1.0 : 1.0;
        cosine = abs(cosine);
    }
    if (!(cosine > 0.0)) // nor NaN: of a hidden triangle
        return kNoEmission;
    vec3 emission = triangleEmission(light, weights);
    float pdf = (1.0 - aim) * cosine * kInvPi * (two_sided ? 0.5 : 1.0);
    if (aim > 0.0)
        pdf += aim * aimedDirectionPdf(position, direction);
    position += 2.0 * (planeError(light.p0, light.p1, light.p2, vec3(0.0)) + kRounding * maxComponent(abs(position))) * normal;
    return Emission(position, direction, emission * (cosine * area / (light.pmf * pdf)));
}

Emission emitEnvironment(Light light, float aim, bool aimed, uint target, vec2 u, uvec2 pick, vec2 v)
{
    LightSample from = sampleEnvironment(light.pmf, pick, v); // its weight: radiance / pdf, selection included
    if (from.pdf == 0.0)
        return kNoEmission;
    float pdf;
    vec3 origin = infiniteOrigin(-from.wi, aim, aimed, target, u, pdf);
    return Emission(origin, -from.wi, from.weight / pdf);
}

/// One photon of `light`, as if the light had been picked with its pmf.
Emission emitFrom(Light light, float aim, bool aimed, uint target, vec2 u, vec2 v, inout Sampler s)
{
    if (hasFeature(kFeatureEnvironment) && light.kind == kLightEnvironment)
        return emitEnvironment(light, aim, aimed, target, u, nextBits(s), v);
    if (hasFeature(kFeatureTriangleLights) && (light.kind == kLightTriangle || light.kind == kLightTriangleTwoSided))
        return emitTriangle(light, aim, aimed, target, u, v, nextPair(s).x);
    if (light.kind != kLightDirectional)
        return emitPoint(light, aim, aimed, target, u);
    float pdf;
    vec3 origin = infiniteOrigin(light.p1, aim, aimed, target, u, pdf);
    return Emission(origin, light.p1, light.emission / (light.pmf * pdf));
}

/// The same of a sun or an environment, from focused origins. @param u place across the beam, @param v of the direction
Emission emitInfinite(Light light, vec2 u, vec2 v, inout Sampler s)
{
    LightSample from = LightSample(-light.p1, kInfinity, vec3(0.0), light.emission / light.pmf, 1.0);
    if (hasFeature(kFeatureEnvironment) && light.kind == kLightEnvironment)
        from = sampleEnvironment(light.pmf, nextBits(s), v);
    if (from.pdf == 0.0)
        return kNoEmission;
    float pdf;
    vec3 origin = focusedOrigin(-from.wi, u, pdf);
    return Emission(origin, -from.wi, from.weight / pdf);
}

/// One photon of the scene's total power. Uses kEmitDimensions pairs of the sampler at most.
/// @param aim probability of being aimed at a specular object; 0 where the scene has none
Emission emitPhoton(float aim, inout Sampler s)
{
    if (scene.light_count == 0u)
        return kNoEmission;
    uvec2 pick = nextBits(s);
    uvec2 target_pick = nextBits(s);
    vec2 u = nextPair(s), v = nextPair(s);
    uint i = toIndex(pick.x, scene.light_count);
    if (toUnitFloat(pick.y) >= light_aliases[i].threshold)
        i = light_aliases[i].alias;
    bool aimed = toUnitFloat(target_pick.x) < aim;
    uint target = aimed ? toIndex(target_pick.y, scene.caustic_target_count) : 0u;
    return emitFrom(loadLight(i), aim, aimed, target, u, v, s);
}

#endif
