// Whether two pixels show one surface. The kernel declares `Guides` and `HistoryParams params` before it includes this. Functions only.
#ifndef LIB_SAME_SURFACE_GLSL
#define LIB_SAME_SURFACE_GLSL
#include "shaders/lib/history.glsl"
#include "shaders/lib/signal.glsl"

const float kOffPlane = 2.0;   // pixels, off the surface's plane, at which another pixel's surface is another one
const float kFarAlong = 32.0;  // pixels, along it: what a pixel covers of a surface seen at 2 degrees
const float kSameFacing = 0.9; // cosine between smooth normals of one surface

SurfaceGuide loadGuide(uint pixel)
{
    uvec4 bits = texelFetch(Guides, int(pixel));
    return SurfaceGuide(uintBitsToFloat(bits.xyz), bits.w);
}

bool sameSurface(SurfaceGuide now, vec3 normal, vec3 old_position, vec3 old_normal, float pixel)
{
    vec3 d = old_position - now.position;
    float rounding = 1e-5 * maxComponent(abs(now.position)); // of positions far from the origin
    return abs(dot(d, normal)) <= kOffPlane * pixel + rounding && dot(d, d) <= square(kFarAlong * pixel + rounding) &&
           dot(old_normal, normal) >= kSameFacing;
}

vec3 smoothNormal(uint normals) { return octahedralToUnit(unpackSnorm4x8(normals).xy); }

bool sameSurface(SurfaceGuide now, vec3 normal, uvec4 old, float pixel)
{
    return sameSurface(now, normal, uintBitsToFloat(old.xyz), smoothNormal(old.w), pixel);
}

/// Metres from a pixel to the next, across.
float footprintAt(Motion motion) { return params.pixel_side + params.pixel_angle * motion.distance; }

#endif
