// Traversal as a sieve: closed surfaces let no ray out.
#include "tests/stages/ray_test.h"

#include <functional>
#include <map>

namespace
{
constexpr uint32_t kRaysInside = 200000;

/// Rays from points near `center`: at random, at every corner of a triangle, and at points of edges.
std::vector<gpu::Ray> raysFromInside(const WorldMesh& mesh, const std::function<gpu::vec3(Random&)>& origin)
{
    Random random(3);
    std::vector<gpu::Ray> rays;
    for (uint32_t i = 0; i < kRaysInside; ++i)
    {
        gpu::Ray ray{.origin = origin(random), .t_max = kFar, .direction = random.direction(), .path = i};
        const gpu::uvec3 t = mesh.triangles[random.below(uint32_t(mesh.triangles.size()))];
        const gpu::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y];
        if (i % 4 == 1)
            ray.direction = directionTo(a, ray.origin);
        if (i % 4 == 2)
            ray.direction = directionTo(lerp(a, b, random.unit()), ray.origin);
        if (i % 4 == 3)
            ray.direction = directionTo(lerp(a, b, float(random.below(9)) / 8), ray.origin);
        rays.push_back(ray);
    }
    return rays;
}

struct Enclosure
{
    const char* name;
    gpu::vec3 center;
    bool sphere;
    bool from_center; // all rays start in the very centre
};

class Enclosed : public Rays, public testing::WithParamInterface<Enclosure>
{
};

TEST_P(Enclosed, RaysNeverEscape)
{
    const Enclosure& e = GetParam();
    TriangleScene builder;
    if (e.sphere)
        builder.sphere(e.center, 1, 24);
    else
        builder.box(e.center + gpu::vec3{-1, -1, -1}, e.center + gpu::vec3{1, 1, 1}, 12);
    const LoadedScene scene = builder.load(device());
    const std::vector<gpu::Ray> rays = raysFromInside(
        builder.mesh(),
        [&](Random& random) {
            return e.from_center ? e.center : random.inBox({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}) + e.center;
        });
    const std::vector<gpu::Hit> hits = closest(scene, rays);
    const std::vector<gpu::vec3> arrived = visible(scene, rays, {1, 1, 1}, {0, 0, 0});
    std::map<uint32_t, uint32_t> escaped, seen_through; // by kind of ray
    for (size_t i = 0; i < rays.size(); ++i)
    {
        escaped[i % 4] += hits[i].slot == gpu::kNone;
        seen_through[i % 4] += arrived[i].x != 0;
    }
    for (uint32_t kind = 0; kind < 4; ++kind)
    {
        EXPECT_EQ(escaped[kind], 0u) << "kind " << kind;
        EXPECT_EQ(seen_through[kind], 0u) << "kind " << kind;
    }
}

INSTANTIATE_TEST_SUITE_P(, Enclosed,
                         testing::Values(Enclosure{"InABox", {0, 0, 0}, false, false},
                                         Enclosure{"InABoxFromItsCentre", {0, 0, 0}, false, true},
                                         Enclosure{"InABoxAKilometreAway", {1000, -1000, 1000}, false, false},
                                         Enclosure{
                                             "InABoxAKilometreAwayFromItsCentre", {1000, -1000, 1000}, false, true},
                                         Enclosure{"InASphere", {0, 0, 0}, true, false},
                                         Enclosure{"InASphereFromItsCentre", {0, 0, 0}, true, true},
                                         Enclosure{"InASphereAKilometreAway", {1000, 1000, -1000}, true, false}),
                         [](const auto& enclosure) { return enclosure.param.name; });
} // namespace
