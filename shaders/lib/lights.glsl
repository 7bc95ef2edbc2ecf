// Choosing and evaluating lights: punctual, emissive triangles, environment. Functions only.
#ifndef LIB_LIGHTS_GLSL
#define LIB_LIGHTS_GLSL
#include "shaders/lib/coverage.glsl"
#include "shaders/lib/math.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/lib/scene.glsl"
#include "shaders/lib/material.glsl"

struct LightSample
{
    vec3 wi;        // unit, from the point to the light
    float distance; // metres
    vec3 position;  // metres, on the light, off an emissive triangle by what rounding needs; nowhere for directional and environment light
    vec3 weight;    // incident radiance / pdf (area, environment) or irradiance at normal incidence / pmf (punctual)
    float pdf;      // per steradian, selection included; 0 for punctual lights, which BSDF sampling cannot hit
};

const LightSample kNoLight = LightSample(vec3(0.0, 0.0, 1.0), 0.0, vec3(0.0), vec3(0.0), 0.0);

vec2 directionToEnvironment(vec3 d)
{
    // Drivers' acos is good to 1e-4 only, a tenth of a texel in a large map; their atan to a few ulps.
    float u = 0.5 + atan(d.z, d.x) * (0.5 * kInvPi) + scene.environment_turn;
    return vec2(u - floor(u), atan(length(d.xz), d.y) * kInvPi);
}

vec3 environmentToDirection(vec2 uv)
{
    float u = uv.x - scene.environment_turn;
    float phi = (u - floor(u) - 0.5) * 2.0 * kPi, theta = uv.y * kPi;
    return vec3(sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi));
}

/// Radiance that arrives from direction d when nothing is in the way.
vec3 environmentRadiance(vec3 d)
{
    if (!hasFeature(kFeatureEnvironment))
        return vec3(0.0);
    vec2 uv = directionToEnvironment(d);
    float rows = float(textureSize(environment_map, 0).y);
    uv.y = clamp(uv.y, 0.5 / rows, 1.0 - 0.5 / rows);
    return loadLight(scene.environment_light).emission * textureLod(environment_map, uv, 0.0).rgb;
}

/// Solid-angle density with which sampleLight() finds direction d within importance texel `index`, selection included.
float environmentTexelPdf(uint index, vec3 d)
{
    float texel_count = float(scene.environment_importance_size.x * scene.environment_importance_size.y);
    float probability = environment_texels[index].probability;
    return loadLight(scene.environment_light).pmf * probability * texel_count / (2.0 * kPi * kPi * max(1e-6, length(d.xz)));
}

/// Solid-angle density with which sampleLight() finds direction d, selection included.
float environmentPdf(vec3 d)
{
    if (!hasFeature(kFeatureEnvironment))
        return 0.0;
    uvec2 size = scene.environment_importance_size;
    uvec2 texel = min(uvec2(directionToEnvironment(d) * vec2(size)), size - 1u);
    return environmentTexelPdf(texel.y * size.x + texel.x, d);
}

/// The same for a point on an emissive triangle seen at `distance` under `cosine`.
float trianglePdf(uint light, float area, float distance, float cosine)
{
    return loadLight(light).pmf * distance * distance / max(area * cosine, 1e-36);
}

LightSample sampleEnvironment(float pmf, uvec2 pick, vec2 u)
{
    uvec2 size = scene.environment_importance_size;
    uint i = toIndex(pick.x, size.x * size.y);
    if (toUnitFloat(pick.y) >= environment_texels[i].threshold)
        i = environment_texels[i].alias;
    vec3 wi = environmentToDirection((vec2(i % size.x, i / size.x) + u) / vec2(size));
    // Not environmentPdf(wi): rounding would give some samples of a sun's texel the density of its dark neighbour.
    float pdf = environmentTexelPdf(i, wi);
    return pdf > 0.0 ? LightSample(wi, kInfinity, vec3(0.0), environmentRadiance(wi) / pdf, pdf) : kNoLight;
}

LightSample samplePunctual(Light light, vec3 point)
{
    if (light.kind == kLightDirectional)
        return LightSample(-light.p1, kInfinity, vec3(0.0), light.emission / light.pmf, 0.0);
    vec3 to_light = light.p0 - point;
    float distance2 = dot(to_light, to_light);
    if (distance2 == 0.0)
        return kNoLight;
    float distance = sqrt(distance2);
    vec3 wi = to_light / distance;
    vec3 intensity = light.emission;
    if (light.kind == kLightSpot)
        intensity *= square(clamp(dot(light.p1, -wi) * light.p2.x + light.p2.y, 0.0, 1.0));
    return LightSample(wi, distance, light.p0, intensity / (distance2 * light.pmf), 0.0);
}

/// Radiance that a triangle light gives at a point of it, texture and alpha applied.
vec3 triangleEmission(Light light, vec3 weights)
{
    if ((!hasFeature(kFeatureEmissiveMaps) && !kSceneHasAlpha) || light.material == kNone)
        return light.emission;
    uvec3 v = loadTriangle(light.triangle).vertices;
    vec2 uv0 = interpolate(weights, loadVertex(v.x).uv0, loadVertex(v.y).uv0, loadVertex(v.z).uv0);
    vec2 uv1 = interpolate(weights, loadVertex(v.x).uv1, loadVertex(v.y).uv1, loadVertex(v.z).uv1);
    vec3 emission = surfaceEmission(light.material, uv0, uv1, vec2(0.0));
    return kSceneHasAlpha ? emission * surfaceCoverage(light.material, v, weights) : emission;
}

LightSample sampleTriangle(Light light, uint index, vec3 point, vec2 u)
{
    float r = sqrt(u.x);
    vec3 weights = vec3(1.0 - r, r * (1.0 - u.y), r * u.y);
    vec3 position = interpolate(weights, light.p0, light.p1, light.p2);
    vec3 twice_area = cross(light.p1 - light.p0, light.p2 - light.p0);
    float doubled = length(twice_area);
    vec3 to_light = position - point;
    float distance = length(to_light);
    vec3 wi = to_light / max(distance, 1e-36);
    float cosine = -dot(wi, twice_area) / doubled;
    if (light.kind == kLightTriangleTwoSided)
        cosine = abs(cosine);
    if (!(cosine > 0.0)) // nor NaN: of a hidden triangle
        return kNoLight;
    vec3 emission = triangleEmission(light, weights);
    float pdf = trianglePdf(index, 0.5 * doubled, distance, cosine);
    vec3 towards = twice_area * (dot(wi, twice_area) < 0.0 ? 1.0 / doubled : -1.0 / doubled);
    position += 2.0 * (planeError(light.p0, light.p1, light.p2, abs(point)) + kRounding * distance) * towards;
    return LightSample(wi, distance, position, emission / pdf, pdf);
}

const uint kLightPairs = 3u; // of the sampler, that a light sample uses up

/// What a light sample is made of: three pairs of the sampler, whatever the light.
struct LightDraws
{
    uvec2 pick;       // of the light
    vec2 u;           // place or direction
    uvec2 texel_pick; // of the environment's texel
};

LightDraws nextLightDraws(inout Sampler s)
{
    LightDraws draws = LightDraws(nextBits(s), nextPair(s), uvec2(0u));
    if (hasFeature(kFeatureEnvironment))
        draws.texel_pick = nextBits(s);
    else
        ++s.dimension;
    return draws;
}

/// A point or direction on light i, as if it had been picked with its pmf.
LightSample sampleLightAt(uint i, vec3 point, LightDraws draws)
{
    Light light = loadLight(i);
    if (hasFeature(kFeatureEnvironment) && light.kind == kLightEnvironment)
        return sampleEnvironment(light.pmf, draws.texel_pick, draws.u);
    if (hasFeature(kFeatureTriangleLights) && (light.kind == kLightTriangle || light.kind == kLightTriangleTwoSided))
        return sampleTriangle(light, i, point, draws.u);
    return hasFeature(kFeaturePunctualLights) ? samplePunctual(light, point) : kNoLight;
}

/// Picks a light by power and a point or direction on it.
LightSample sampleLight(vec3 point, inout Sampler s)
{
    LightDraws draws = nextLightDraws(s);
    if (scene.light_count == 0u)
        return kNoLight;
    uint i = toIndex(draws.pick.x, scene.light_count);
    if (toUnitFloat(draws.pick.y) >= light_aliases[i].threshold)
        i = light_aliases[i].alias;
    return sampleLightAt(i, point, draws);
}

/// Multiple importance sampling, power heuristic with exponent 2 (Veach & Guibas 1995).
float misWeight(float pdf, float other)
{
    return 1.0 / (1.0 + square(other / pdf)); // squares of what is near an emitter are beyond floats
}

#endif
