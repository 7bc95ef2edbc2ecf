// How large the things in view are (descriptor set 0). Functions only.
#ifndef LIB_VIEW_SCALE_GLSL
#define LIB_VIEW_SCALE_GLSL
#include "format/gpu_scene.h"
#include "shaders/view_scale/view_scale.h"

layout(set = 0, binding = kViewScaleBinding, scalar) readonly buffer ViewScaleBlock { ViewScale view_scale; };

/// Metres that p is away from the viewer, or the view distance where that is more: what lengths at p are measured by.
float viewDistance(vec3 p) { return max(length(p - view_scale.focus), view_scale.distance); }

#endif
