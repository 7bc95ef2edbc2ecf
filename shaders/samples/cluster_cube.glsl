// The cube that the sums of a cluster's points are kept in. Functions only.
#ifndef SAMPLES_CLUSTER_CUBE_GLSL
#define SAMPLES_CLUSTER_CUBE_GLSL
#include "shaders/lib/view_scale.glsl"

/// Its width, metres, around the cluster's centre: a cluster's points lie nearer to it than it lies to the viewer, or count as
/// if they did.
float cubeWidth(vec3 center) { return 2.0 * viewDistance(center); }

#endif
