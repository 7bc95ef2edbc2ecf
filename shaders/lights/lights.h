// Lights that change. Shared by runtime/scene_lights.cpp and shaders/lights/set.comp.
#ifndef SHADERS_LIGHTS_H
#define SHADERS_LIGHTS_H
#include "format/gpu_scene.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kSetLightsGroupSize = 64u;

struct SetLight // what of a Light can change; p0 to p2 but for triangles, whose corners follow geometry
{
    uint light; // index into Lights
    vec3 emission;
    vec3 p0;
    vec3 p1;
    vec3 p2;
};
GPU_SIZE(SetLight, 52);
GPU_OFFSET(SetLight, emission, 4);

struct SetLightsParams
{
    uint change_count; // SetLight
    uint pmf_count;    // all lights' probabilities, or 0: they stay
};
GPU_SIZE(SetLightsParams, 8);

GPU_NAMESPACE_END
#endif
