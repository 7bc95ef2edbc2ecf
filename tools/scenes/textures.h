// Procedural, seamlessly repeating textures.
#pragma once
#include "tools/scenes/vec.h"

#include <cstdint>
#include <vector>

struct Texture
{
    uint32_t size = 0;          // square, texels
    std::vector<uint8_t> rgb;   // [3 * size * size], row 0 on top
    std::vector<uint8_t> alpha; // [size * size]; empty: opaque
};

/// What the maps of one material have in common: how it looks, how its surface is bent, how rough it is.
struct SurfaceTextures
{
    Texture color;     // sRGB
    Texture normal;    // tangent space, +Y up as glTF has it
    Texture roughness; // G: roughness, B: metallic (0); empty where the factor alone will do
};

SurfaceTextures marbleTiles(uint32_t size); // 2 x 2 m: checkered slabs with a dark inlay
SurfaceTextures bricks(uint32_t size);      // 1.5 x 1.5 m, running bond
SurfaceTextures plaster(uint32_t size);     // 2 x 2 m
SurfaceTextures limestone(uint32_t size);   // 1 x 1 m
SurfaceTextures wovenCloth(uint32_t size);  // grey, to be tinted; one banner
SurfaceTextures planks(uint32_t size);      // 1 x 1 m, grain along v
