// Moving geometry of a given size, to measure how the time of a frame grows.
#include "tools/scenes/rooms.h"
#include "tools/scenes/scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace
{
constexpr float kSide = 80; // metres

/// The ground, a sun and a view of both.
void addSurroundings(GltfWriter& gltf, uint32_t material)
{
    gltf.add("ground",
             sheet(1, 1, {kSide, kSide},
                   [](float s, float t) {
                       return Vec3{(s - 0.5f) * kSide, 0, (0.5f - t) * kSide};
                   }),
             material);
    gltf.addSun("sun", {-0.3f, -1, -0.2f}, {1, 1, 1}, 5);
    gltf.addCamera("view", {0, 6, 26}, {0, 3, 0}, 0.8f);
}

float part(double step, uint32_t i)
{
    return float(std::fmod(step * (i + 1), 1.0));
}

/// Incommensurable steps spread boxes evenly and never put two in one place (Roberts 2018).
Vec3 boxPlace(uint32_t i)
{
    return {(part(0.8191725134, i) - 0.5f) * kSide / 2, 0.3f + 8 * part(0.6710436067, i),
            (part(0.5497004779, i) - 0.5f) * kSide / 2};
}
} // namespace

GltfWriter boxesScene(uint32_t count)
{
    GltfWriter gltf;
    const uint32_t white = gltf.addMaterial(matte("white", {0.8f, 0.8f, 0.8f}));
    addSurroundings(gltf, white);
    const uint32_t mesh = gltf.addMesh("box", box({-0.15f, -0.15f, -0.15f}, {0.15f, 0.15f, 0.15f}, 0), white);
    const float r = std::sqrt(0.5f);
    for (uint32_t i = 0; i < count; ++i)
    {
        const Vec3 at = boxPlace(i);
        const Vec3 to =
            at + Vec3{part(0.7548776662, i) - 0.5f, part(0.5698402910, i), part(0.6180339887, i) - 0.5f} * 2;
        const uint32_t node = gltf.addNode("box", mesh, at);
        gltf.animate(node, "translation", {0, 1, 2}, {at.x, at.y, at.z, to.x, to.y, to.z, at.x, at.y, at.z});
        gltf.animate(node, "rotation", {0, 1, 2}, {0, 0, 0, 1, r, 0, 0, r, 0, 0, 0, 1});
    }
    return gltf;
}

GltfWriter swarmScene(uint32_t count)
{
    constexpr uint32_t kStops = 4;
    constexpr uint64_t kPrime = 7919; // multiplied by it, neighbours go to places far apart
    GltfWriter gltf;
    const uint32_t white = gltf.addMaterial(matte("white", {0.8f, 0.8f, 0.8f}));
    addSurroundings(gltf, white);
    const uint32_t mesh = gltf.addMesh("box", box({-0.15f, -0.15f, -0.15f}, {0.15f, 0.15f, 0.15f}, 0), white);
    for (uint32_t i = 0; i < count; ++i)
    {
        std::vector<float> times, places;
        uint64_t place = i;
        for (uint32_t stop = 0; stop <= kStops; ++stop)
        {
            const Vec3 at = boxPlace(stop == kStops ? i : uint32_t(place));
            times.push_back(float(stop));
            places.insert(places.end(), {at.x, at.y, at.z});
            place = place * kPrime % count;
        }
        gltf.animate(gltf.addNode("box", mesh, boxPlace(i)), "translation", times, places);
    }
    return gltf;
}

GltfWriter tubeScene(uint32_t triangles)
{
    constexpr uint16_t kJoints = 32;
    constexpr uint32_t kAround = 64;
    constexpr float kHeight = 8;
    GltfWriter gltf;
    const uint32_t white = gltf.addMaterial(matte("white", {0.8f, 0.8f, 0.8f}));
    addSurroundings(gltf, white);
    const uint32_t rows = std::max(1u, triangles / (2 * kAround));
    const Mesh tube = sheet(kAround, rows, {2 * std::numbers::pi_v<float>, kHeight},
                            [](float s, float t)
                            {
                                const float angle = 2 * std::numbers::pi_v<float> * s;
                                return Vec3{std::cos(angle), kHeight * t, -std::sin(angle)};
                            });
    std::vector<std::array<float, 4>> weights;
    std::vector<std::array<uint16_t, 4>> joints_of_vertex;
    for (const Vec3& p : tube.positions)
    {
        const float along = p.y / kHeight * (kJoints - 1);
        const auto joint = uint16_t(std::clamp(along, 0.0f, kJoints - 2.0f));
        weights.push_back({1 - (along - joint), along - joint, 0, 0});
        joints_of_vertex.push_back({joint, uint16_t(joint + 1), 0, 0});
    }
    std::vector<GltfWriter::Joint> joints;
    for (int i = 0; i < kJoints; ++i)
        joints.push_back({"joint", i - 1, {0, i == 0 ? 0 : kHeight / (kJoints - 1), 0}});
    const float sine = std::sin(0.06f), cosine = std::cos(0.06f); // of half the bend of a joint
    for (const uint32_t node : gltf.addSkinned("tube", tube, white, joints, weights, joints_of_vertex))
        gltf.animate(node, "rotation", {0, 1, 2}, {0, 0, 0, 1, sine, 0, 0, cosine, 0, 0, sine, cosine});
    return gltf;
}
