#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/antialias/antialias.h"
#include "shaders/lib/math.glsl"

// The mean of this frame, which samples one point of each pixel, and of the last picture, reprojected and clipped to the range of
// the pixel's neighbourhood (Karis 2014, "High-Quality Temporal Supersampling"; Salvi 2016, "An Excursion in
// Temporal Supersampling"). One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { AntialiasParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Picture { vec3 picture[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Motions { Motion motions[]; };
layout(set = 1, binding = 2, scalar) readonly buffer OldShown { vec3 old_shown[]; };
layout(set = 1, binding = 3, scalar) readonly buffer OldCounts { float old_counts[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Shown { vec3 shown[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer Counts { float counts[]; };
layout(set = 1, binding = 6, scalar) readonly buffer Direct { vec3 direct[]; };
layout(set = 1, binding = 7, scalar) readonly buffer Factors { float factors[]; };

const float kWithin = 1.25; // standard deviations of the surroundings: fewer cut off what is there, more let ghosts stay

ivec2 size() { return ivec2(params.width, quotient(params.point_count, params.width)); }
uint pixelAt(ivec2 place)
{
    place = clamp(place, ivec2(0), size() - 1);
    return uint(place.y * size().x + place.x);
}

vec3 toYCoCg(vec3 c) { return vec3(0.25 * c.r + 0.5 * c.g + 0.25 * c.b, 0.5 * c.r - 0.5 * c.b, 0.5 * c.g - 0.25 * c.r - 0.25 * c.b); }
vec3 fromYCoCg(vec3 c) { return vec3(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z); }

bool isFinite(vec3 c) { return !any(isnan(c)) && !any(isinf(c)); }

/// The last picture at `at`, by cubic convolution (Catmull-Rom): means of means stay sharp.
vec3 lastPicture(vec2 at)
{
    ivec2 corner = ivec2(floor(at));
    vec2 t = at - vec2(corner);
    vec2 weights[4];
    weights[0] = t * (-0.5 + t * (1.0 - 0.5 * t));
    weights[1] = 1.0 + t * t * (-2.5 + 1.5 * t);
    weights[2] = t * (0.5 + t * (2.0 - 1.5 * t));
    weights[3] = t * t * (-0.5 + 0.5 * t);
    vec3 sum = vec3(0.0);
    [[unroll]] for (int y = 0; y < 4; ++y)
        [[unroll]] for (int x = 0; x < 4; ++x)
            sum += weights[x].x * weights[y].y * old_shown[pixelAt(corner + ivec2(x, y) - 1)];
    return max(sum, vec3(0.0));
}

/// What the pixel's light has changed by since the last frame as highlights moved: of its part that is direct light.
float highlightChange(uint pixel)
{
    float part = clamp(luminance(direct[pixel]) / max(luminance(picture[pixel]), 1e-30), 0.0, 1.0);
    return mix(1.0, factors[pixel], part);
}

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.point_count)
        return;
    uint row = quotient(pixel, params.width);
    ivec2 here = ivec2(pixel - row * params.width, row);
    vec3 own = picture[pixel], mean = vec3(0.0), squares = vec3(0.0);
    float count = 0.0, nearest = kInfinity;
    vec2 from = motions[pixel].from;
    [[unroll]] for (int k = 0; k < 9; ++k)
    {
        uint neighbour = pixelAt(here + ivec2(k % 3, k / 3) - 1);
        Motion motion = motions[neighbour];
        if (motion.distance < nearest) // an edge moves with what is in front
        {
            nearest = motion.distance;
            from = motion.from;
        }
        if (!isFinite(picture[neighbour]))
            continue;
        vec3 c = toYCoCg(picture[neighbour]);
        mean += c;
        squares += c * c;
        count += 1.0;
    }
    vec2 at = vec2(here) + from;
    bool known = from.x != kNoMotion && all(greaterThanEqual(at, vec2(-0.5))) && all(lessThan(at, vec2(size()) - 0.5));
    float frames = known ? min(old_counts[pixelAt(ivec2(floor(at + 0.5)))], float(params.most_frames)) : 0.0;
    vec3 old = known ? params.factor * lastPicture(at) : own;
    if (params.highlights != 0u)
        old *= highlightChange(pixel);
    if (!(count > 0.0) || !isFinite(old))
        frames = 0.0;
    if (frames > 0.0)
    {
        mean /= count;
        vec3 reach = kWithin * sqrt(max(squares / count - mean * mean, vec3(0.0)));
        vec3 d = toYCoCg(old) - mean, over = abs(d) / max(reach, 1e-6 * mean.x + 1e-30);
        float most = max(over.x, max(over.y, over.z));
        if (most > 1.0)
            old = max(fromYCoCg(mean + d / most), vec3(0.0));
        own = isFinite(own) ? mix(old, own, 1.0 / (frames + 1.0)) : old;
    }
    bool fine = isFinite(own);
    shown[pixel] = fine ? own : vec3(0.0);
    counts[pixel] = fine ? frames + 1.0 : 0.0;
}
