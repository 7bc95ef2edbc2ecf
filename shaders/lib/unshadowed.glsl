// What a light sends through a BSDF if nothing is in the way. Functions only.
#ifndef LIB_UNSHADOWED_GLSL
#define LIB_UNSHADOWED_GLSL
#include "shaders/lib/lights.glsl"
#include "shaders/lib/path.glsl"

/// Over the candidate's density. Against the BSDF's ray it is weighed as one sample of its cluster, however many candidates there
/// are: where the BSDF finds the light better, it keeps its say.
vec3 unshadowed(PathVertex v, LightSample light)
{
    vec3 wi = light.wi * v.frame;
    if (light.weight == vec3(0.0) || !sidesAgree(v.surface, light.wi, wi.z))
        return vec3(0.0);
    BsdfValue f = evaluateBsdf(v.bsdf, v.wo, wi);
    float mis = light.pdf > 0.0 ? misWeight(light.pdf, f.pdf) : 1.0;
    return (f.diffuse + f.specular) * abs(wi.z) * light.weight * mis;
}

#endif
