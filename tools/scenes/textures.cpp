#include "tools/scenes/textures.h"

#include "image/write_image.h"

#include <algorithm>
#include <functional>

namespace
{

constexpr float kPi = 3.14159265f;

uint32_t hash(uint32_t x, uint32_t y, uint32_t seed)
{
    uint32_t h = x * 0x9e3779b1u ^ y * 0x85ebca77u ^ seed * 0xc2b2ae3du;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return h ^ (h >> 15);
}

float random(int x, int y, uint32_t seed)
{
    return float(hash(uint32_t(x), uint32_t(y), seed) >> 8) / 16777216.0f;
}

/// Value noise in 0..1 that repeats after `period` lattice cells; x and y run over 0..1.
float noise(float x, float y, int period, uint32_t seed)
{
    const float fx = x * float(period), fy = y * float(period);
    const int ix = int(std::floor(fx)), iy = int(std::floor(fy));
    const auto smooth = [](float t) { return t * t * (3 - 2 * t); };
    const float s = smooth(fx - float(ix)), t = smooth(fy - float(iy));
    const auto lattice = [&](int i, int j)
    { return random((i % period + period) % period, (j % period + period) % period, seed); };
    const float low = lattice(ix, iy) * (1 - s) + lattice(ix + 1, iy) * s;
    const float high = lattice(ix, iy + 1) * (1 - s) + lattice(ix + 1, iy + 1) * s;
    return low * (1 - t) + high * t;
}

/// Several octaves of noise, about 0.5 on average.
float turbulence(float x, float y, int period, int octaves, uint32_t seed)
{
    float sum = 0, weight = 0.5f, total = 0;
    for (int i = 0; i < octaves; ++i)
    {
        sum += weight * noise(x, y, period << i, seed + uint32_t(i));
        total += weight;
        weight *= 0.5f;
    }
    return sum / total;
}

Vec3 mix(Vec3 a, Vec3 b, float t)
{
    return a * (1 - t) + b * t;
}

float step(float low, float high, float x) // smooth
{
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

struct Texel
{
    Vec3 color;      // linear
    float height;    // metres
    float roughness; // 0..1
};

/// `texel(x, y)` for x, y in 0..1, y downwards; `extent`: metres across the texture.
SurfaceTextures paint(uint32_t size, float extent, bool with_roughness, const std::function<Texel(float, float)>& texel)
{
    std::vector<float> heights;
    SurfaceTextures textures;
    textures.color.size = textures.normal.size = size;
    const auto byte = [](float v) { return uint8_t(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); };
    for (uint32_t j = 0; j < size; ++j)
    {
        for (uint32_t i = 0; i < size; ++i)
        {
            const Texel t = texel((float(i) + 0.5f) / float(size), (float(j) + 0.5f) / float(size));
            for (float channel : {t.color.x, t.color.y, t.color.z})
                textures.color.rgb.push_back(srgbByte(channel));
            heights.push_back(t.height);
            if (with_roughness)
                for (float channel : {1.0f, t.roughness, 0.0f})
                    textures.roughness.rgb.push_back(byte(channel));
        }
    }
    textures.roughness.size = with_roughness ? size : 0;
    const float spacing = extent / float(size);
    const auto height = [&](uint32_t i, uint32_t j) { return heights[size_t(j % size) * size + i % size]; };
    for (uint32_t j = 0; j < size; ++j)
    {
        for (uint32_t i = 0; i < size; ++i)
        {
            const float dx = (height(i + 1, j) - height(i + size - 1, j)) / (2 * spacing);
            const float dy = (height(i, j + size - 1) - height(i, j + 1)) / (2 * spacing);
            const Vec3 n = normalize({-dx, -dy, 1});
            for (float component : {n.x, n.y, n.z})
                textures.normal.rgb.push_back(byte(0.5f * component + 0.5f));
        }
    }
    return textures;
}

/// Thin wandering lines, 1 on the line.
float veins(float x, float y, int period, uint32_t seed)
{
    const float bend = turbulence(x, y, period, 4, seed);
    const float wave = std::abs(std::sin(kPi * (2 * x + 4 * y) + 9.0f * bend));
    return std::pow(1 - wave, 6.0f);
}

} // namespace

SurfaceTextures marbleTiles(uint32_t size)
{
    return paint(size, 2.0f, true,
                 [](float x, float y)
                 {
                     // Four slabs of 1 m around which runs an inlay of 8 cm; each quarter has its own stone and cut.
                     const int i = x < 0.5f ? 0 : 1, j = y < 0.5f ? 0 : 1;
                     const float u = 2 * x - float(i), v = 2 * y - float(j);
                     const float edge = std::min(std::min(u, 1 - u), std::min(v, 1 - v)); // metres from the slab's edge
                     const float diamond = std::abs(u - 0.5f) + std::abs(v - 0.5f);
                     const bool light = (i + j) % 2 == 0;
                     const float vein = veins(x, y, 3, light ? 11 : 23);
                     const float cloud = turbulence(x, y, 4, 4, 31);
                     Vec3 color = light ? mix({0.74f, 0.70f, 0.63f}, {0.55f, 0.51f, 0.45f}, 0.7f * vein + 0.35f * cloud)
                                        : mix({0.36f, 0.22f, 0.16f}, {0.52f, 0.40f, 0.33f}, 0.5f * vein + 0.4f * cloud);
                     if (diamond < 0.24f)
                         color = light ? mix({0.30f, 0.17f, 0.12f}, {0.45f, 0.33f, 0.27f}, vein)
                                       : mix({0.60f, 0.54f, 0.44f}, {0.45f, 0.40f, 0.34f}, vein);
                     const bool inlay = edge > 0.05f && edge < 0.11f;
                     if (inlay)
                         color = mix({0.055f, 0.06f, 0.065f}, {0.10f, 0.10f, 0.10f}, cloud);
                     const float joint = step(0.0f, 0.006f, edge) * step(0.0f, 0.004f, std::abs(edge - 0.05f)) *
                                         step(0.0f, 0.004f, std::abs(edge - 0.11f)) *
                                         step(0.0f, 0.004f, std::abs(diamond - 0.24f));
                     color = mix({0.16f, 0.14f, 0.12f}, color, joint);
                     return Texel{color, 0.0015f * joint, 0.75f - joint * (0.53f - 0.10f * cloud)};
                 });
}

SurfaceTextures bricks(uint32_t size)
{
    return paint(size, 1.5f, false,
                 [](float x, float y)
                 {
                     const int rows = 18, columns = 6; // 25 x 8.3 cm
                     const float row = y * rows;
                     const int j = int(row);
                     const float column = x * columns + (j % 2 == 0 ? 0.0f : 0.5f);
                     const int i = int(column) % columns;
                     const float u = (column - std::floor(column)) * 0.25f,
                                 v = (row - float(j)) * (1.5f / rows); // metres
                     const float wobble = 0.004f * (turbulence(x, y, 24, 2, 5) - 0.5f);
                     const float edge = std::min(std::min(u, 0.25f - u), std::min(v, 1.5f / rows - v)) + wobble;
                     const float body = step(0.004f, 0.011f, edge);
                     const float tone = random(i, j, 77), grain = turbulence(x, y, 40, 3, 9);
                     const Vec3 brick = mix(mix({0.46f, 0.24f, 0.15f}, {0.58f, 0.37f, 0.26f}, tone),
                                            {0.26f, 0.13f, 0.09f}, 0.5f * grain);
                     const Vec3 mortar = mix({0.50f, 0.46f, 0.40f}, {0.38f, 0.35f, 0.31f}, grain);
                     return Texel{mix(mortar, brick, body), 0.006f * body + 0.0015f * grain, 1};
                 });
}

SurfaceTextures plaster(uint32_t size)
{
    return paint(size, 2.0f, false,
                 [](float x, float y)
                 {
                     const float broad = turbulence(x, y, 3, 3, 41), fine = turbulence(x, y, 48, 2, 43);
                     const Vec3 color = mix({0.80f, 0.74f, 0.64f}, {0.70f, 0.61f, 0.49f}, step(0.35f, 0.75f, broad));
                     return Texel{color * (0.97f + 0.05f * fine), 0.002f * broad + 0.0006f * fine, 1};
                 });
}

SurfaceTextures limestone(uint32_t size)
{
    return paint(size, 1.0f, false,
                 [](float x, float y)
                 {
                     const float cloud = turbulence(x, y, 5, 4, 51), pores = turbulence(x, y, 60, 2, 53);
                     const float pit = step(0.72f, 0.85f, pores);
                     const Vec3 color = mix({0.76f, 0.72f, 0.65f}, {0.64f, 0.59f, 0.51f}, cloud) * (1 - 0.25f * pit);
                     return Texel{color, 0.0008f * cloud - 0.0008f * pit, 1};
                 });
}

SurfaceTextures wovenCloth(uint32_t size)
{
    return paint(size, 1.4f, false,
                 [](float x, float y)
                 {
                     const float threads = 96;
                     const float warp = std::sin(2 * kPi * threads * x), weft = std::sin(2 * kPi * threads * y);
                     const int parity = (int(x * threads * 2) + int(y * threads * 2)) % 2;
                     const float weave = parity == 0 ? std::abs(warp) : std::abs(weft);
                     // A border and a row of lozenges: worked in lighter thread.
                     const float edge = std::min(x, 1 - x);
                     const bool border = (edge > 0.05f && edge < 0.075f) || (edge > 0.09f && edge < 0.10f);
                     const float repeat = y * 5 - std::floor(y * 5);
                     const float lozenge = std::abs(x - 0.5f) / 0.16f + std::abs(repeat - 0.5f) / 0.38f;
                     const bool figure = (lozenge < 1.0f && lozenge > 0.8f) || lozenge < 0.35f;
                     const float tone = (border || figure ? 0.95f : 0.62f) * (0.85f + 0.15f * weave) *
                                        (0.92f + 0.16f * turbulence(x, y, 12, 3, 61));
                     return Texel{{tone, tone, tone}, 0.0008f * weave, 1};
                 });
}

SurfaceTextures planks(uint32_t size)
{
    return paint(
        size, 1.0f, false,
        [](float x, float y)
        {
            const int count = 5;
            const int plank = int(x * count);
            const float across = x * count - float(plank);
            const float edge = std::min(across, 1 - across) / count;
            const float offset = random(plank, 0, 71);
            const float grain = turbulence(x, std::fmod(y * 0.125f + offset, 1.0f), 48, 3, 73);
            const float joint = step(0.0f, 0.006f, edge);
            const Vec3 color = mix({0.20f, 0.115f, 0.06f}, {0.34f, 0.21f, 0.12f}, grain) * (0.8f + 0.35f * offset);
            return Texel{color * (0.35f + 0.65f * joint), 0.003f * joint + 0.0008f * grain, 1};
        });
}
