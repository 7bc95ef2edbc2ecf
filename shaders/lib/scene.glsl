// Descriptor set 0: the scene. The one place that names its blocks; lib/ functions and kernels read them.
#ifndef LIB_SCENE_GLSL
#define LIB_SCENE_GLSL
#include "format/gpu_scene.h"
#include "shaders/lib/view_scale.glsl"

// Features of the scene, constant when the pipeline is built: absent ones cost nothing.
layout(constant_id = 0) const uint kSceneFeatures = 0xffffffffu; // kFeature*
layout(constant_id = 1) const uint kUsedTexturePages = kTexturePageCount;
bool hasFeature(uint feature) { return (kSceneFeatures & feature) != 0u; }
const bool kSceneHasAlpha = (kSceneFeatures & kFeatureAlpha) != 0u;
const bool kSceneHasThin = (kSceneFeatures & kFeatureThin) != 0u;
const bool kSceneHasTranslucency = (kSceneFeatures & (kFeatureAlpha | kFeatureThin)) != 0u;

layout(set = 0, binding = kSceneInfoBinding, scalar) uniform SceneBlock { SceneInfo scene; };
// What every ray reads lies in texel buffers of four 32-bit words a texel: software Vulkan fetches a texel with one wide
// load, where a storage buffer costs it one bounds-checked load a word (twice the rays a second; no difference on a GPU).
// Kernels read trees, photons, samples, rays and hits in set 1 likewise (Device::texelArray); each has its load function.
layout(set = 0, binding = kBvhNodesBinding) uniform usamplerBuffer bvh_nodes;
layout(set = 0, binding = kBvhTrianglesBinding) uniform usamplerBuffer bvh_triangles;
layout(set = 0, binding = kTrianglesBinding) uniform usamplerBuffer triangles;
layout(set = 0, binding = kVertexAttributesBinding) uniform usamplerBuffer vertices;
layout(set = 0, binding = kMaterialsBinding) uniform usamplerBuffer materials;
layout(set = 0, binding = kLightsBinding) uniform usamplerBuffer lights;
layout(set = 0, binding = kTextureRefsBinding, scalar) readonly buffer TextureRefs { TextureRef texture_refs[]; };
layout(set = 0, binding = kLightAliasesBinding, scalar) readonly buffer LightAliases { AliasEntry light_aliases[]; };
layout(set = 0, binding = kEnvironmentTexelsBinding, scalar) readonly buffer EnvironmentTexels { EnvironmentTexel environment_texels[]; };
layout(set = 0, binding = kTexturePagesBinding) uniform sampler2DArray texture_pages[kTexturePageCount];
layout(set = 0, binding = kEnvironmentMapBinding) uniform sampler2D environment_map;

// ---- The structs of gpu_scene.h from their texels (GPU_OFFSET there pins the rows). Texels whose members are not used
// are not fetched.

const uint kBvhNodeRows = 7u; // min x, max x, min y, max y, min z, max z, children; fetched row by row in lib/bvh.glsl

BvhTriangle loadBvhTriangle(uint slot)
{
    uvec4 a = texelFetch(bvh_triangles, int(3u * slot));
    uvec4 b = texelFetch(bvh_triangles, int(3u * slot + 1u));
    uvec4 c = texelFetch(bvh_triangles, int(3u * slot + 2u));
    return BvhTriangle(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), c.w);
}

Triangle loadTriangle(uint index)
{
    uvec4 a = texelFetch(triangles, int(index));
    return Triangle(a.xyz, a.w);
}

VertexAttributes loadVertex(uint index)
{
    uvec4 a = texelFetch(vertices, int(2u * index));
    uvec4 b = texelFetch(vertices, int(2u * index + 1u));
    return VertexAttributes(a.x, a.y, uintBitsToFloat(a.zw), uintBitsToFloat(b.xy), b.zw);
}

float materialFloat(uint index, uint word) { return uintBitsToFloat(texelFetch(materials, int(kMaterialRows * index + word / 4u))[word % 4u]); }
vec3 materialVec3(uint index, uint word)
{
    return vec3(materialFloat(index, word), materialFloat(index, word + 1u), materialFloat(index, word + 2u));
}
uint materialUint(uint index, uint word) { return texelFetch(materials, int(kMaterialRows * index + word / 4u))[word % 4u]; }

Material loadMaterial(uint index)
{
#define float_FIELD materialFloat
#define vec3_FIELD materialVec3
#define NUMBER(word, type, name, default_, least, most, meaning) m.name = type##_FIELD(index, word);
#define FLAGS(word, name, meaning) m.name = materialUint(index, word);
#define TEXTURE(word, name, encoding, channels, feature, meaning) m.name = materialUint(index, word);
    Material m;
    MATERIAL_FIELDS(NUMBER, FLAGS, TEXTURE)
    return m;
#undef NUMBER
#undef FLAGS
#undef TEXTURE
}

Light loadLight(uint index)
{
    int row = int(4u * index);
    uvec4 a = texelFetch(lights, row), b = texelFetch(lights, row + 1);
    uvec4 c = texelFetch(lights, row + 2), d = texelFetch(lights, row + 3);
    return Light(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), uintBitsToFloat(c.w),
                 uintBitsToFloat(d.xyz), d.w);
}

#endif
