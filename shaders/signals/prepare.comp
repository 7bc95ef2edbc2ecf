#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_terms.glsl"
#include "shaders/lib/path.glsl"
#include "shaders/lib/signal.glsl"
#include "shaders/pose/pose.h"

// Collects the data of a pixel for filters and histories: position and normals of its surface, motion vector, light, reflectance.
// One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { SignalParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Views { FrameViews views; };
layout(set = 1, binding = 1) uniform usamplerBuffer Points;
layout(set = 1, binding = 2, scalar) readonly buffer Direct { vec3 direct[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Glossy { vec3 glossy[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Guides { SurfaceGuide guides[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer Motions { Motion motions[]; };
layout(set = 1, binding = 6, scalar) writeonly buffer DirectSignals { LightSignal direct_signals[]; };
layout(set = 1, binding = 7, scalar) writeonly buffer GlossySignals { LightSignal glossy_signals[]; };
layout(set = 1, binding = 8, scalar) readonly buffer LastCorners { TriangleCorners last_corners[]; };
layout(set = 1, binding = 9, scalar) writeonly buffer Displacements { vec3 displacements[]; }; // where something can move

#include "shaders/lib/motion.glsl"
#include "shaders/lib/point.glsl"

/// A signal of unknown error.
LightSignal signalOf(vec3 light, vec3 reflectance, float lobe)
{
    return packSignal(Signal(light, max(reflectance, vec3(kLeastReflectance)), max(lobe, 1.0 / 255.0), -1.0));
}

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.point_count)
        return;
    ShadingPoint point = loadPoint(pixel);
    LightSignal direct_signal = packSignal(Signal(vec3(0.0), vec3(0.0), 0.0, 0.0)), glossy_signal = direct_signal;
    vec3 smooth_normal = vec3(0.0, 0.0, 1.0), normal = smooth_normal;
    if (point.slot != kNone)
    {
        PathVertex v = vertexAt(point);
        float cosine = max(0.0, v.wo.z);
        vec3 specular = hasGlossyLobe(v.bsdf) ? specularReflectance(v.bsdf, cosine) : vec3(0.0);
        vec3 both = specular + diffuseReflectance(v.bsdf, cosine);
        float share = luminance(specular) / max(luminance(both), 1e-20);
        if ((params.terms & kLightDirect) != 0u)
            direct_signal = signalOf(direct[pixel], point.throughput * both, mix(1.0, sharpestAlpha(v.bsdf), share));
        if ((params.terms & kLightGlossy) != 0u && hasGlossyLobe(v.bsdf)) // else it sends no ray
            glossy_signal = signalOf(glossy[pixel], point.throughput * specular, sharpestAlpha(v.bsdf));
        smooth_normal = v.surface.smooth_normal;
        normal = v.surface.normal;
    }
    direct_signals[pixel] = direct_signal;
    if (kSceneHasGlossy)
        glossy_signals[pixel] = glossy_signal;
    guides[pixel] = SurfaceGuide(point.slot != kNone ? point.position : vec3(kInfinity), packSnorm4x8(vec4(unitToOctahedral(smooth_normal), unitToOctahedral(normal))));
    vec3 displacement = displacementOf(point);
    motions[pixel] = motionOf(pixel, point, displacement, params.spread, params.has_previous != 0u);
    if (scene.first_moving_slot != kNone)
        displacements[pixel] = displacement;
}
