#include "tools/scenes/atrium_parts.h"

#include <numbers>

namespace
{

constexpr float kPi = std::numbers::pi_v<float>;

/// Appends a half-round bulge from (r, y0) to (r, y1).
void bulge(std::vector<Vec2>& profile, float r, float y0, float y1, float out, int steps)
{
    for (int i = 0; i <= steps; ++i)
    {
        const float a = kPi * float(i) / float(steps);
        profile.push_back({r + out * std::sin(a), 0.5f * (y0 + y1) - 0.5f * (y1 - y0) * std::cos(a)});
    }
}

} // namespace

Mesh lowerColumn(float height)
{
    Mesh mesh = box({-0.34f, 0, -0.34f}, {0.34f, 0.16f, 0.34f}, 0.012f);
    std::vector<Vec2> base;
    bulge(base, 0.30f, 0.16f, 0.26f, 0.035f, 4);
    base.insert(base.end(), {{0.275f, 0.265f}, {0.265f, 0.30f}});
    bulge(base, 0.26f, 0.305f, 0.355f, 0.02f, 3);
    base.push_back({0.235f, 0.38f});
    mesh.add(lathe(base, 24));
    const float shaft = height - 0.38f - 0.34f;
    mesh.add(flutedShaft(0.24f, shaft, 16), at(0, 0.38f, 0));
    const float top = height - 0.34f;
    std::vector<Vec2> capital = {{0.20f, top - 0.02f}};
    bulge(capital, 0.21f, top - 0.01f, top + 0.03f, 0.02f, 3);
    for (int i = 0; i <= 4; ++i) // the echinus swells
        capital.push_back({0.215f + 0.09f * std::sin(0.5f * kPi * float(i) / 4), top + 0.04f + 0.16f * float(i) / 4});
    capital.push_back({0.29f, top + 0.21f});
    mesh.add(lathe(capital, 24));
    mesh.add(box({-0.335f, height - 0.135f, -0.335f}, {0.335f, height, 0.335f}, 0.012f));
    return mesh;
}

Mesh upperColumn(float height)
{
    Mesh mesh = box({-0.25f, 0, -0.25f}, {0.25f, 0.12f, 0.25f}, 0.01f);
    std::vector<Vec2> profile;
    bulge(profile, 0.19f, 0.12f, 0.20f, 0.03f, 4);
    profile.insert(profile.end(), {{0.165f, 0.22f}, {0.16f, 0.24f}, {0.135f, height - 0.36f}});
    bulge(profile, 0.14f, height - 0.36f, height - 0.32f, 0.015f, 3);
    profile.insert(profile.end(), {{0.14f, height - 0.31f}, {0.17f, height - 0.22f}, {0.23f, height - 0.13f}});
    mesh.add(lathe(profile, 20));
    mesh.add(box({-0.26f, height - 0.13f, -0.26f}, {0.26f, height, 0.26f}, 0.01f));
    return mesh;
}

Mesh baluster()
{
    return lathe({{0.055f, 0},
                  {0.055f, 0.06f},
                  {0.035f, 0.08f},
                  {0.06f, 0.20f},
                  {0.062f, 0.26f},
                  {0.03f, 0.45f},
                  {0.028f, 0.60f},
                  {0.055f, 0.65f},
                  {0.055f, 0.72f}},
                 8);
}

Mesh banner(float width, float drop, float fold, float phase)
{
    return sheet(26, 32, {1, 1},
                 [=](float s, float t)
                 {
                     const float down = 1 - t; // 0 at the rod
                     const float waves =
                         std::sin(2 * kPi * (2.5f * s + phase) + 0.9f * std::sin(3.0f * down + phase * 7));
                     const float ripple = std::sin(2 * kPi * (5.3f * s - 0.4f * down) + phase * 11);
                     const float depth = fold * (0.25f + 0.75f * down) * (waves + 0.25f * ripple);
                     const float swing = 0.04f * std::sin(2.4f * down + phase * 5) * down;
                     const float gather = 1 - 0.06f * down * (1 + 0.5f * std::sin(4 * down + phase));
                     return Vec3{(s - 0.5f) * width * gather,
                                 -drop * down + 0.02f * std::cos(2 * kPi * (2.5f * s + phase)) * down, depth + swing};
                 });
}

Mesh pedestal(float height)
{
    Mesh mesh = box({-0.26f, 0, -0.26f}, {0.26f, 0.12f, 0.26f}, 0.012f);
    mesh.add(box({-0.21f, 0.12f, -0.21f}, {0.21f, height - 0.08f, 0.21f}, 0.02f));
    mesh.add(box({-0.25f, height - 0.08f, -0.25f}, {0.25f, height, 0.25f}, 0.015f));
    return mesh;
}

Mesh urn()
{
    std::vector<Vec2> profile = {{0, 0.001f}, {0.12f, 0.001f}, {0.125f, 0.02f}, {0.06f, 0.05f}, {0.05f, 0.08f}};
    for (int i = 0; i <= 24; ++i)
    {
        const float t = float(i) / 24;
        const float belly = std::sin(kPi * std::pow(t, 0.8f));
        profile.push_back({0.055f + 0.15f * belly + 0.02f * t, 0.09f + 0.46f * t});
    }
    profile.insert(profile.end(), {{0.085f, 0.58f},
                                   {0.11f, 0.61f},
                                   {0.115f, 0.615f},
                                   {0.11f, 0.62f},
                                   {0.09f, 0.60f},
                                   {0.06f, 0.55f},
                                   {0, 0.54f}});
    return lathe(profile, 48);
}

Mesh goblet()
{
    return lathe({{0, 0.001f},
                  {0.12f, 0.001f},
                  {0.13f, 0.012f},
                  {0.12f, 0.02f},
                  {0.03f, 0.05f},
                  {0.022f, 0.10f},
                  {0.03f, 0.17f},
                  {0.09f, 0.22f},
                  {0.13f, 0.30f},
                  {0.145f, 0.40f},
                  {0.14f, 0.50f},
                  {0.134f, 0.505f},
                  {0.128f, 0.50f},
                  {0.132f, 0.40f},
                  {0.117f, 0.31f},
                  {0.08f, 0.245f},
                  {0, 0.215f}},
                 64);
}

Mesh lanternFrame(float rod)
{
    Mesh mesh;
    for (float x : {-0.14f, 0.14f})
        for (float z : {-0.14f, 0.14f})
            mesh.add(box({x - 0.012f, -0.21f, z - 0.012f}, {x + 0.012f, 0.21f, z + 0.012f}));
    mesh.add(box({-0.17f, -0.24f, -0.17f}, {0.17f, -0.205f, 0.17f}, 0.008f));
    mesh.add(box({-0.17f, 0.205f, -0.17f}, {0.17f, 0.24f, 0.17f}, 0.008f));
    mesh.add(lathe({{0.14f, 0.24f}, {0.10f, 0.30f}, {0.03f, 0.34f}, {0.012f, 0.36f}, {0.012f, 0.36f + rod}}, 16));
    return mesh;
}

Mesh frame(float width, float height, float bar, float depth)
{
    Mesh mesh;
    const float h = 0.5f * width, d = 0.5f * depth, bevel = 0.2f * bar;
    mesh.add(box({-h - bar, -bar, -d}, {h + bar, 0, d}, bevel));
    mesh.add(box({-h - bar, height, -d}, {h + bar, height + bar, d}, bevel));
    // Uprights reach a little into the rails, where their ends are hidden.
    mesh.add(box({-h - bar * 0.99f, -bevel, -0.98f * d}, {-h, height + bevel, 0.98f * d}, 0.9f * bevel));
    mesh.add(box({h, -bevel, -0.98f * d}, {h + bar * 0.99f, height + bevel, 0.98f * d}, 0.9f * bevel));
    return mesh;
}

Mesh basin(float radius)
{
    return lathe({{radius + 0.10f, 0},
                  {radius + 0.10f, 0.08f},
                  {radius + 0.06f, 0.10f},
                  {radius + 0.03f, 0.34f},
                  {radius + 0.07f, 0.40f},
                  {radius + 0.09f, 0.42f},
                  {radius + 0.09f, 0.48f},
                  {radius + 0.07f, 0.50f},
                  {radius - 0.07f, 0.50f},
                  {radius - 0.09f, 0.48f},
                  {radius - 0.10f, 0.30f}},
                 48);
}
