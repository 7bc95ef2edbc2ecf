#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/denoise/signal.glsl"
#include "shaders/lib/path.glsl"

// Gathers what the filter asks of a pixel: where its surface is and faces, the light it has, and how much it would reflect.
// One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { DenoiseParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Guides { DenoiseGuide guides[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Signals { DenoiseSignal signals[]; };

const float kLeastReflectance = 1e-4; // no light is lost where a lobe's fit says none, and no half is too small

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.point_count)
        return;
    ShadingPoint point = points[pixel];
    Signal signal = Signal(vec3(0.0), vec3(0.0), 0.0, 0.0);
    vec3 smooth_normal = vec3(0.0, 0.0, 1.0), normal = smooth_normal;
    if (point.slot != kNone)
    {
        PathVertex v = vertexAt(point);
        Surface s = v.surface;
        Bsdf b = v.bsdf;
        float cosine = max(0.0, v.wo.z);
        vec3 specular = hasGlossyLobe(b) ? specularReflectance(b, cosine) : vec3(0.0);
        vec3 reflectance = params.glossy != 0u ? specular : specular + diffuseReflectance(b, cosine);
        float share = luminance(specular) / max(luminance(reflectance), 1e-20);
        if (params.glossy == 0u || hasGlossyLobe(b)) // else it sends no ray
            signal = Signal(radiance[pixel], max(point.throughput * reflectance, vec3(kLeastReflectance)),
                            max(mix(1.0, sharpestAlpha(b), share), 1.0 / 255.0), 0.0);
        smooth_normal = s.smooth_normal;
        normal = s.normal;
    }
    signals[pixel] = packSignal(signal);
    guides[pixel] =
        DenoiseGuide(point.position, packSnorm4x8(vec4(unitToOctahedral(smooth_normal), unitToOctahedral(normal))));
}
