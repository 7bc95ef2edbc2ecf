// The surface at a shading point. Functions only.
#ifndef LIB_SHADING_POINT_GLSL
#define LIB_SHADING_POINT_GLSL
#include "shaders/lib/surface.glsl"
#include "shaders/primary/primary.h"

Surface surfaceAt(ShadingPoint point)
{
    Surface s = surfaceAt(point.slot, point.barycentrics, point.direction, point.width);
    s.position = point.position;
    s.back = point.back;
    return s;
}

#endif
