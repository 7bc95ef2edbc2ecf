// Measuring how large the things in view are. Shared by runtime/stages/view_scale.cpp and shaders/view_scale/measure.comp.
#ifndef SHADERS_VIEW_SCALE_MEASURE_H
#define SHADERS_VIEW_SCALE_MEASURE_H
#include "format/gpu_types.h"

GPU_NAMESPACE_BEGIN

// A camera of narrow angle is far from the little that it shows, and an orthographic one may be anywhere: both count as if they
// stood nearer, where a usual one would show as much.
struct MeasureViewParams
{
    vec3 eye;
    vec3 forward; // unit
    uint point_count;
    uint orthographic;
    float size; // of an orthographic picture, metres; else the view distance as a fraction of the mean one, at most 1
};
GPU_SIZE(MeasureViewParams, 36);

GPU_NAMESPACE_END
#endif
