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

struct BsdfDrawParams
{
    uint count;
    uint seed;
    uint visible_normals; // 1: draw those alone
    uint front;           // 1: seen from the front
    uint flags;           // kMaterial*
    float base_color;
    float metallic;
    float roughness;
    float transmission;
    float specular;
    float ior;
    vec3 wo; // unit, local
};
GPU_SIZE(BsdfDrawParams, 56);

struct DirectionDraw
{
    vec3 direction; // unit
    float pdf;      // that the sampler gives, per steradian; 0: nothing was drawn
};
GPU_SIZE(DirectionDraw, 16);

struct TextureDrawParams
{
    uint count;
    uint texture; // index into TextureRefs
    uint normal;  // 1: as a normal map, -1 to 1
};
GPU_SIZE(TextureDrawParams, 12);

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

GPU_NAMESPACE_END
#endif
