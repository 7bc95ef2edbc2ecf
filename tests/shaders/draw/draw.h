// Draws from samplers, and what textures show, one a thread. Shared by tests/shaders/draw/*.comp and tests/stages/*.cpp.
#ifndef TESTS_SHADERS_DRAW_H
#define TESTS_SHADERS_DRAW_H
#include "shaders/photons/photons.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kDrawGroupSize = 64u;

struct DrawParams
{
    uint count;
    uint seed;
    float aim;  // probability of aiming photons at caustic targets
    vec3 point; // that is lit; or the normal about which gathering rays go
};
GPU_SIZE(DrawParams, 24);

GPU_CONST uint kDrawDirections = 0u;     // that the BSDF chooses
GPU_CONST uint kDrawVisibleNormals = 1u; // of its microfacets
GPU_CONST uint kDrawValues = 2u;         // of the BSDF towards directions of equal solid angle

struct BsdfDrawParams
{
    uint count;
    uint seed;
    uint what;  // kDraw*
    uint front; // 1: seen from the front
    uint flags; // kMaterial*
    float base_color;
    float metallic;
    float roughness;
    float transmission;
    float specular;
    float ior;
    vec3 wo; // unit, local
    float clearcoat;
    float clearcoat_roughness;
    float sheen; // the same in every channel
    float sheen_roughness;
    float anisotropy;
    float iridescence;
    float film_ior;
    float film_thickness; // nm
    float diffuse_transmission;
    float dispersion;      // > 0: every draw stands for one channel
    vec3 clearcoat_normal; // unit, local
};
GPU_SIZE(BsdfDrawParams, 108);

struct DirectionDraw
{
    vec3 direction; // unit
    float pdf;      // that the sampler gives, per steradian; 0: nothing was drawn
};
GPU_SIZE(DirectionDraw, 16);

struct BsdfDraw
{
    vec3 direction; // unit
    float pdf;      // per steradian, 0 for a delta lobe and where nothing was drawn
    vec3 weight;    // f |cos| / pdf of a chosen direction, 0: absorbed; f of one that was given
    float reverse;  // red of f with both directions exchanged, of one that was given
};
GPU_SIZE(BsdfDraw, 32);
struct TextureDrawParams
{
    uint count;
    uint texture; // index into TextureRefs
    uint normal;  // 1: as a normal map, -1 to 1
};
GPU_SIZE(TextureDrawParams, 12);

struct TexturePlace // in surface coordinates
{
    vec2 uv;
    vec2 axis_a; // conjugate diameters of what is seen at once
    vec2 axis_b;
};
GPU_SIZE(TexturePlace, 24);

struct LightDraw
{
    vec3 direction;
    float pdf;
    vec3 weight;
    float distance; // metres; 0: nothing was drawn
};
GPU_SIZE(LightDraw, 32);

struct CellDraw
{
    uint cell;
    float rest; // what is left of the random number, 0..1
};
GPU_SIZE(CellDraw, 8);

struct PairDraw
{
    vec2 pair;
    float weight; // density of the uniform pair over this one's
    uint cell;    // that its direction lies in
};
GPU_SIZE(PairDraw, 16);

GPU_NAMESPACE_END
#endif
