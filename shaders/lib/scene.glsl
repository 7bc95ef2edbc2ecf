// Descriptor set 0: the scene. The one place that names its blocks; lib/ functions and kernels read them.
#ifndef LIB_SCENE_GLSL
#define LIB_SCENE_GLSL
#include "format/gpu_scene.h"

// What the scene has, known when the pipeline is built: what it has not costs nothing.
layout(constant_id = 0) const uint kSceneFeatures = 0xffffffffu; // kFeature*
layout(constant_id = 1) const uint kUsedTexturePages = kTexturePageCount;
bool hasFeature(uint feature) { return (kSceneFeatures & feature) != 0u; }
const bool kSceneHasAlpha = (kSceneFeatures & kFeatureAlpha) != 0u;
const bool kSceneHasThin = (kSceneFeatures & kFeatureThin) != 0u;
const bool kSceneHasTranslucency = (kSceneFeatures & (kFeatureAlpha | kFeatureThin)) != 0u;

layout(set = 0, binding = kSceneInfoBinding, scalar) uniform SceneBlock { SceneInfo scene; };
layout(set = 0, binding = kBvhNodesBinding, scalar) readonly buffer BvhNodes { uvec4 bvh_rows[]; };
const uint kBvhNodeRows = 7u; // BvhNode as rows: min x, max x, min y, max y, min z, max z, children
layout(set = 0, binding = kBvhTrianglesBinding, scalar) readonly buffer BvhTriangles { BvhTriangle bvh_triangles[]; };
layout(set = 0, binding = kTrianglesBinding, scalar) readonly buffer Triangles { Triangle triangles[]; };
layout(set = 0, binding = kVertexAttributesBinding, scalar) readonly buffer Vertices { VertexAttributes vertices[]; };
layout(set = 0, binding = kMaterialsBinding, scalar) readonly buffer Materials { Material materials[]; };
layout(set = 0, binding = kTextureRefsBinding, scalar) readonly buffer TextureRefs { TextureRef texture_refs[]; };
layout(set = 0, binding = kLightsBinding, scalar) readonly buffer Lights { Light lights[]; };
layout(set = 0, binding = kLightAliasesBinding, scalar) readonly buffer LightAliases { AliasEntry light_aliases[]; };
layout(set = 0, binding = kEnvironmentTexelsBinding, scalar) readonly buffer EnvironmentTexels { EnvironmentTexel environment_texels[]; };
layout(set = 0, binding = kTexturePagesBinding) uniform sampler2DArray texture_pages[kTexturePageCount];
layout(set = 0, binding = kEnvironmentMapBinding) uniform sampler2D environment_map;

#endif
