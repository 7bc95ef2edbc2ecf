// The scene as shaders read it: one definition for compiler, player and GLSL. So it lies in a package, too, but for geometry,
// which a package stores in less space (stored_geometry.h).
// Scalar layout. World space is glTF's: right-handed, +Y up, in units of length of the package
// (META's unit, 1 m nearly always), which stand for metres throughout. Radiometry is SI, RGB linear Rec. 709.
#ifndef FORMAT_GPU_SCENE_H
#define FORMAT_GPU_SCENE_H
#include "format/gpu_types.h"
#include "format/material_fields.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kNone = 0xffffffffu; // "no such index", wherever an index is optional

// ---- Bounding volume hierarchy -------------------------------------------------------------------------------------

GPU_CONST uint kBvhWidth = 4u;
GPU_CONST uint kTraversalStackSize = 64u; // entries; the compiler builds no deeper tree, the reader refuses one

// A child reference is kNone (no child: its bounds are empty, min > max), an inner node's index (in a package
// greater than its parent's: the tree is acyclic), or a leaf: kLeafBit | (triangle_count - 1) << kLeafCountShift | first BvhTriangle.
GPU_CONST uint kLeafBit = 0x80000000u;
GPU_CONST uint kLeafCountShift = 28u;
GPU_CONST uint kLeafCountMask = 0x7u; // 1..8 triangles a leaf
GPU_CONST uint kLeafFirstMask = 0x0fffffffu;

struct BvhNode // four children, bounds as structure of arrays: component i belongs to child[i]
{
    vec4 min_x;
    vec4 max_x;
    vec4 min_y;
    vec4 max_y;
    vec4 min_z;
    vec4 max_z;
    uvec4 child;
};
GPU_SIZE(BvhNode, 112);

GPU_CONST uint kTriangleAlpha = 1u; // BvhTriangle.flags: alpha mask or blend: traversal must look at its coverage
GPU_CONST uint kTriangleThin = 2u;  // thin-walled smooth transmission: shadow rays pass, tinted

struct BvhTriangle // in leaf order; spatial splits may store one triangle several times, but only once one with flags
{
    vec3 v0;       // metres, world space, counter-clockwise seen from the front
    uint triangle; // index into Triangles
    vec3 v1;
    uint material; // index into Materials
    vec3 v2;
    uint flags; // kTriangle*
};
GPU_SIZE(BvhTriangle, 48);
GPU_OFFSET(BvhTriangle, v1, 16);
GPU_OFFSET(BvhTriangle, v2, 32);

// ---- Surfaces ------------------------------------------------------------------------------------------------------

struct Triangle
{
    uvec3 vertices; // indices into VertexAttributes
    uint light;     // index into Lights, kNone where the triangle does not emit
};
GPU_SIZE(Triangle, 16);
GPU_OFFSET(Triangle, light, 12);

struct VertexAttributes
{
    uint normal;  // octahedral, 2 x 16-bit snorm (packSnorm2x16), unit length, world space
    uint tangent; // octahedral, x: bits 0..15 snorm16, y: bits 17..31 (snorm15 << 17), bit 16: set = bitangent sign -1;
                  // 0x00000000 only where no normal map or anisotropy needs one
    vec2 uv0;     // TEXCOORD_0, glTF convention (v down)
    vec2 uv1;     // TEXCOORD_1
    uvec2 color;  // COLOR_0, linear RGBA as 4 halfs (packHalf2x16(rg), packHalf2x16(ba)); 1 where absent
};
GPU_SIZE(VertexAttributes, 32);
GPU_OFFSET(VertexAttributes, uv1, 16);
GPU_OFFSET(VertexAttributes, color, 24);

// Material.flags
GPU_CONST uint kMaterialAlphaMask = 1u;   // coverage = alpha >= alpha_cutoff
GPU_CONST uint kMaterialAlphaBlend = 2u;  // coverage = alpha
GPU_CONST uint kMaterialDoubleSided = 4u; // emits on both sides; reflection is always two-sided
GPU_CONST uint kMaterialUnlit =
    8u; // KHR_materials_unlit: shows base_color to the eye, takes no part in light transport
GPU_CONST uint kMaterialThin = 16u; // transmission > 0 without a volume: thin-walled, no refraction

GPU_CONST uint kEncodingLinear = 0u; // of textures that materials name
GPU_CONST uint kEncodingSrgb = 1u;
GPU_CONST uint kEncodingNormal = 2u; // unit vectors, linear
GPU_CONST uint kRed = 1u, kGreen = 2u, kBlue = 4u, kAlpha = 8u;
GPU_CONST float kUnbounded = 3.402823466e38f;

struct Material // glTF 2.0 metallic-roughness and KHR_materials_*; meanings in material_fields.h
{
#define NUMBER(word, type, name, default_, least, most, meaning) type name;
#define FLAGS(word, name, meaning) uint name;
#define TEXTURE(word, name, encoding, channels, feature, meaning) uint name;
    MATERIAL_FIELDS(NUMBER, FLAGS, TEXTURE)
#undef NUMBER
#undef FLAGS
#undef TEXTURE
};
GPU_CONST uint kMaterialRows = MATERIAL_WORDS / 4u; // of four words: what a kernel fetches at once
GPU_SIZE(Material, 4 * MATERIAL_WORDS);
#define NUMBER(word, type, name, default_, least, most, meaning) GPU_OFFSET(Material, name, 4 * word);
#define FLAGS(word, name, meaning) GPU_OFFSET(Material, name, 4 * word);
#define TEXTURE(word, name, encoding, channels, feature, meaning) GPU_OFFSET(Material, name, 4 * word);
#ifdef __cplusplus
MATERIAL_FIELDS(NUMBER, FLAGS, TEXTURE)
#endif
#undef NUMBER
#undef FLAGS
#undef TEXTURE

GPU_CONST float kSmoothRoughness = 0.03; // below it a specular lobe is a perfect mirror or a perfect refraction

GPU_CONST uint kTexturePageCount =
    16u; // array textures a scene may use: one per size and encoding, or many sizes in tiles

// TextureRef.sampling: bits 0-1 wrap u, bits 2-3 wrap v, bit 4 nearest, bit 5 use TEXCOORD_1, bit 6 tile, bit 7 x and y only
GPU_CONST uint kWrapRepeat = 0u;
GPU_CONST uint kWrapClamp = 1u;
GPU_CONST uint kWrapMirror = 2u;
GPU_CONST uint kSampleNearest = 16u;
GPU_CONST uint kSampleUv1 = 32u;
GPU_CONST uint kSampleTile = 64u;      // a tile of a tiled page (texture_tile.h), else a whole layer
GPU_CONST uint kSampleNormalXy = 128u; // a unit vector of which only x and y are stored; z >= 0

struct TextureRef // one use of a texture: which layer of which page, and how
{
    uint page; // < kTexturePageCount
    uint layer;
    uint sampling;
    uint origin; // of the tile, texels: x in bits 0..15, y in bits 16..31; multiples of 4; 0 for a whole layer
    uint size;   // of level 0, texels: width in bits 0..15, height in bits 16..31
    vec3 u_row;  // u' = dot(u_row, vec3(u, v, 1)): KHR_texture_transform
    vec3 v_row;
};
GPU_SIZE(TextureRef, 44);

// ---- Lights --------------------------------------------------------------------------------------------------------

GPU_CONST uint kLightPoint = 0u;
GPU_CONST uint kLightSpot = 1u;
GPU_CONST uint kLightDirectional = 2u;
GPU_CONST uint kLightTriangle = 3u;         // emits on its front side
GPU_CONST uint kLightTriangleTwoSided = 4u; // emits on both sides
GPU_CONST uint kLightEnvironment = 5u;      // at most one, always the last light

struct Light
{
    vec3 p0;       // point, spot: position. triangle: vertex 0
    uint kind;     // kLight*
    vec3 p1;       // spot, directional: unit vector, the way the light travels. triangle: vertex 1
    uint triangle; // triangle: index into Triangles, else kNone
    vec3 p2;       // spot: (cone_scale, cone_offset, 0), see below. triangle: vertex 2
    float pmf;     // probability of being picked by the alias table; about its share of the power
    vec3
        emission; // point, spot: W/sr. directional: W/m^2. triangle: W/(m^2 sr) before texture and alpha. environment: factor
    uint material; // triangle whose emission varies, by an emissive texture or alpha: its material, else kNone
};
GPU_SIZE(Light, 64);
GPU_OFFSET(Light, p1, 16);
GPU_OFFSET(Light, p2, 32);
GPU_OFFSET(Light, emission, 48);
// Spot falloff (KHR_lights_punctual): clamp(dot(p1, -wi) * cone_scale + cone_offset, 0, 1)^2 with
// cone_scale = 1 / max(0.001, cos(inner) - cos(outer)), cone_offset = -cos(outer) * cone_scale.

struct AliasEntry // Walker/Vose: pick i uniformly, keep it if a second uniform number < threshold, else take alias
{
    float threshold;
    uint alias;
};
GPU_SIZE(AliasEntry, 8);

// The environment is an equirectangular map: direction (x,y,z) -> u = 0.5 + (atan2(z, x) + rotation) / 2pi, v = acos(y) / pi,
// row 0 at +Y; rotation is META's, about +Y as a node's would be. Radiance is bilinearly filtered (u repeats, v clamps). Importance is a coarser grid over the same (u,v):
struct EnvironmentTexel
{
    float threshold; // alias table over the texels, row-major
    uint alias;
    float probability; // of this texel; never 0 where filtered radiance is not
};
GPU_SIZE(EnvironmentTexel, 12);

struct CausticTarget // bounding sphere of one specular object: where caustic photons are aimed
{
    vec3 center;
    float radius;
};
GPU_SIZE(CausticTarget, 16);

// What a scene has, so that kernels can be built without what it has not (specialization constant 0)
GPU_CONST uint kFeatureAlpha = 1u;        // triangles with kTriangleAlpha
GPU_CONST uint kFeatureThin = 2u;         // triangles with kTriangleThin
GPU_CONST uint kFeatureTransmission = 4u; // materials that transmit
GPU_CONST uint kFeaturePunctualLights = 8u;
GPU_CONST uint kFeatureTriangleLights = 16u;
GPU_CONST uint kFeatureEnvironment = 32u;
GPU_CONST uint kFeatureNormalMaps = 64u;
GPU_CONST uint kFeatureMetallicRoughnessMaps = 128u;
GPU_CONST uint kFeatureEmissiveMaps = 256u;
GPU_CONST uint kFeatureRareMaps = 512u;  // all others
GPU_CONST uint kFeatureMetal = 1024u;    // materials with metallic > 0
GPU_CONST uint kFeatureSpecular = 2048u; // materials with any specular reflection or transmission
GPU_CONST uint kFeatureBaseColorMaps = 4096u;
GPU_CONST uint kFeatureSecondUv = 8192u;      // textures that use TEXCOORD_1
GPU_CONST uint kFeatureVertexColors = 16384u; // vertices that are not white
GPU_CONST uint kFeatureClearcoat = 32768u;
GPU_CONST uint kFeatureSheen = 65536u;
GPU_CONST uint kFeatureAnisotropy = 131072u;
GPU_CONST uint kFeatureIridescence = 262144u;
GPU_CONST uint kFeatureDispersion = 524288u;
GPU_CONST uint kFeatureDiffuseTransmission = 1048576u;
GPU_CONST uint kFeatureTiles = 2097152u; // textures in tiled pages
GPU_CONST uint kFeatureDeltaLobes =
    4194304u; // mirrors, clear glass or smooth layers; textures may make some of any roughness

struct SceneInfo // uniform block: what every kernel may need to know of the scene
{
    vec3 bounds_min; // metres
    uint light_count;
    vec3 bounds_max;
    uint environment_light;            // index into Lights or kNone
    uvec2 environment_importance_size; // texels; 0 without environment
    uint caustic_target_count;
    uint triangle_count;
    float environment_turn; // by how much of a whole turn the environment is rotated about +Y, -0.5 to 0.5
    uint first_moving_slot; // BvhTriangles from here on can move; kNone: none can
};
GPU_SIZE(SceneInfo, 56);

// ---- Descriptor set 0: the scene, the same for every kernel --------------------------------------------------------

GPU_CONST uint kSceneInfoBinding = 0u;
GPU_CONST uint kBvhNodesBinding = 1u; // 1..6: texel buffers, RGBA32UI
GPU_CONST uint kBvhTrianglesBinding = 2u;
GPU_CONST uint kTrianglesBinding = 3u;
GPU_CONST uint kVertexAttributesBinding = 4u;
GPU_CONST uint kMaterialsBinding = 5u;
GPU_CONST uint kLightsBinding = 6u;
GPU_CONST uint kTextureRefsBinding = 7u; // 7..11: storage buffers
GPU_CONST uint kLightAliasesBinding = 8u;
GPU_CONST uint kEnvironmentTexelsBinding = 9u;
GPU_CONST uint kCausticTargetsBinding = 10u;
GPU_CONST uint kViewScaleBinding = 11u;      // made anew in every frame (shaders/view_scale)
GPU_CONST uint kTexturePagesBinding = 12u;   // sampler2DArray[kTexturePageCount]
GPU_CONST uint kEnvironmentMapBinding = 13u; // sampler2D

GPU_NAMESPACE_END
#endif
