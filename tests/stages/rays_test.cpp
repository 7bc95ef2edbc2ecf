// The one traversal against brute force over all triangles, and through translucent layers.
#include "tests/stages/brute_force.h"
#include "tests/stages/ray_test.h"

#include <array>
#include <cmath>
#include <map>

namespace
{
// ---- Against brute force -------------------------------------------------------------------------------------------

/// A few thousand triangles of every kind in the unit cube, moved by `offset`.
TriangleScene mixedScene(gpu::vec3 offset)
{
    TriangleScene scene;
    Random random(7);
    const auto point = [&] { return random.inBox({0, 0, 0}, {1, 1, 1}) + offset; };
    for (int i = 0; i < 800; ++i) // a soup of all sizes
    {
        const gpu::vec3 a = point();
        const float size = std::pow(10.0f, random.between(-2, -0.3f));
        scene.triangle(a, a + size * random.direction(), a + size * random.direction());
    }
    for (int i = 0; i < 200; ++i) // slivers: one side 1000 and more times shorter than the others
    {
        const gpu::vec3 a = point(), b = point();
        scene.triangle(a, b, b + std::pow(10.0f, random.between(-5, -3)) * random.direction());
    }
    for (int i = 0; i < 40; ++i) // axis-parallel boxes
    {
        const gpu::vec3 low = point();
        scene.box(low, low + random.inBox({0.01f, 0.01f, 0.01f}, {0.2f, 0.2f, 0.2f}), 1);
    }
    for (int i = 0; i < 60; ++i) // quads that overlap in one plane
        scene.quad(random.inBox({0, 0.5f, 0}, {0.7f, 0.5f, 0.7f}) + offset, {random.between(0.05f, 0.3f), 0, 0},
                   {0, 0, random.between(0.05f, 0.3f)});
    return scene;
}

std::vector<gpu::Ray> mixedRays(std::span<const gpu::BvhTriangle> triangles, gpu::vec3 offset, uint32_t count)
{
    Random random(11);
    const auto axis = [&]
    {
        std::array<float, 3> d{0, 0, 0};
        d[random.below(3)] = random.below(2) ? 1.0f : -1.0f;
        if (random.below(4) == 0)
            for (float& x : d)
                x = x == 0 ? -0.0f : x;
        return gpu::vec3{d[0], d[1], d[2]};
    };
    const auto inPlane = [&] // one component zero
    {
        const float phi = random.between(0, 6.2831853f);
        const std::array<float, 2> d{std::cos(phi), std::sin(phi)};
        const uint32_t zero = random.below(3);
        return zero == 0 ? gpu::vec3{0, d[0], d[1]} : zero == 1 ? gpu::vec3{d[0], 0, d[1]} : gpu::vec3{d[0], d[1], 0};
    };
    std::vector<gpu::Ray> rays;
    for (uint32_t i = 0; i < count; ++i)
    {
        const gpu::BvhTriangle& some = triangles[random.below(uint32_t(triangles.size()))];
        gpu::Ray ray{.origin = random.inBox({-0.2f, -0.2f, -0.2f}, {1.2f, 1.2f, 1.2f}) + offset,
                     .t_max = kFar,
                     .direction = random.direction(),
                     .path = i};
        if (i % 4 == 1)
            ray.origin = random.onTriangle(some);
        if (i % 8 == 2)
            ray.direction = axis();
        if (i % 8 == 6)
            ray.direction = inPlane();
        if (i % 4 == 3) // at a triangle, often a very thin one
            ray.direction = directionTo(random.onTriangle(some), ray.origin);
        if (i % 3 == 0)
            ray.t_max = random.between(0.01f, 1.5f);
        rays.push_back(ray);
    }
    return rays;
}

/// Everything a hit must be by brute force; `decided` counts rays for which rounding left no choice of hit or miss.
void expectNearest(const gpu::Ray& ray, const gpu::Hit& hit, std::span<const gpu::BvhTriangle> triangles,
                   uint32_t& decided)
{
    SCOPED_TRACE(fmt::format("ray {} from {} {} {} along {} {} {} to {}", ray.path, ray.origin.x, ray.origin.y,
                             ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.t_max));
    const std::vector<Meeting> all = meetings(ray, triangles);
    const bool any_certain = std::ranges::any_of(all, &Meeting::certain);
    decided += any_certain || all.empty();
    if (hit.slot == gpu::kNone)
    {
        EXPECT_FALSE(any_certain);
        return;
    }
    const auto met = std::ranges::find(all, hit.slot, &Meeting::slot);
    ASSERT_NE(met, all.end()) << "triangle " << hit.slot << " at " << hit.t << " is not in the ray's way";
    EXPECT_GT(hit.t, 0);
    EXPECT_LT(hit.t, ray.t_max);
    if (std::isfinite(met->t_error))
    {
        EXPECT_LE(std::abs(hit.t - met->t), met->t_error) << hit.t << " is not " << met->t;
        EXPECT_LE(std::abs(hit.barycentrics.x - met->u), met->weight_error);
        EXPECT_LE(std::abs(hit.barycentrics.y - met->v), met->weight_error);
    }
    for (const Meeting& m : all)
        EXPECT_TRUE(!m.certain || hit.t <= m.t + m.t_error)
            << "triangle " << m.slot << " at " << m.t << " is nearer than " << hit.slot;
}

struct Place
{
    const char* name;
    gpu::vec3 offset;
    double least_decided; // fraction of the rays
};

class RaysAt : public Rays, public testing::WithParamInterface<Place>
{
};

TEST_P(RaysAt, FindTheNearestTriangleOfAll)
{
    const LoadedScene scene = mixedScene(GetParam().offset).load(device());
    const auto triangles = scene.package.bvhTriangles();
    const std::vector<gpu::Ray> rays = mixedRays(triangles, GetParam().offset, 12000);
    const std::vector<gpu::Hit> hits = closest(scene, rays);
    uint32_t decided = 0;
    for (size_t i = 0; i < rays.size() && !HasFailure(); ++i)
        expectNearest(rays[i], hits[i], triangles, decided);
    EXPECT_GE(decided, GetParam().least_decided * double(rays.size())); // else the bounds would excuse anything
}

TEST_P(RaysAt, AreVisibleWhereNothingIsInBetween)
{
    const LoadedScene scene = mixedScene(GetParam().offset).load(device());
    const auto triangles = scene.package.bvhTriangles();
    const std::vector<gpu::Ray> rays = mixedRays(triangles, GetParam().offset, 12000);
    const std::vector<gpu::vec3> arrived = visible(scene, rays, {1, 2, 4}, {16, 32, 64});
    uint32_t decided = 0, seen = 0;
    for (size_t i = 0; i < rays.size() && !HasFailure(); ++i)
    {
        const std::vector<Meeting> all = meetings(rays[i], triangles);
        const bool blocked = std::ranges::any_of(all, [](const Meeting& m) { return m.certain && !m.ends_on_it; });
        const bool passed = arrived[i].x == 17;
        EXPECT_EQ(arrived[i].x, passed ? 17 : 16) << i;
        EXPECT_EQ(arrived[i].y, passed ? 34 : 32) << i;
        EXPECT_EQ(arrived[i].z, passed ? 68 : 64) << i;
        if (blocked || all.empty())
        {
            EXPECT_EQ(passed, !blocked) << i;
            ++decided;
        }
        seen += passed;
    }
    EXPECT_GE(decided, GetParam().least_decided * double(rays.size()));
    EXPECT_GT(seen, rays.size() / 20);
    EXPECT_LT(seen, rays.size() - rays.size() / 20);
}

INSTANTIATE_TEST_SUITE_P(, RaysAt,
                         testing::Values(Place{"TheOrigin", {0, 0, 0}, 0.9},
                                         Place{"AKilometreAway", {1000, -1000, 1000}, 0.7}),
                         [](const auto& place) { return place.param.name; });

TEST_F(Rays, EndAtTheirGreatestDistance)
{
    TriangleScene builder;
    builder.quad({-1, -1, 2}, {2, 0, 0}, {0, 2, 0});
    const LoadedScene scene = builder.load(device());
    const auto ray = [](float t_max) {
        return gpu::Ray{.origin = {0.25f, 0.5f, 0}, .t_max = t_max, .direction = {0, 0, 1}, .path = 0};
    };
    const float below = std::nextafter(2.0f, 0.0f), above = std::nextafter(2.0f, 3.0f);
    const std::vector<gpu::Ray> rays{ray(0), ray(1), ray(below), ray(2), ray(above), ray(3), ray(kFar)};
    const std::vector<gpu::Hit> hits = closest(scene, rays);
    const std::vector<gpu::vec3> arrived = visible(scene, rays, {1, 1, 1}, {0, 0, 0});
    for (size_t i = 0; i < rays.size(); ++i)
    {
        const bool met = rays[i].t_max > 2; // all of this scene's numbers are exact
        EXPECT_EQ(hits[i].slot != gpu::kNone, met) << rays[i].t_max;
        const bool beyond = rays[i].t_max > above; // what a shadow ray ends on does not shadow
        EXPECT_EQ(arrived[i].x, beyond ? 0 : 1) << rays[i].t_max;
        EXPECT_EQ(hits[i].t, met ? 2 : rays[i].t_max);
    }
}

// ---- Translucent surfaces ------------------------------------------------------------------------------------------

gpu::Material blend(float alpha)
{
    gpu::Material m = plainMaterial();
    m.flags = gpu::kMaterialAlphaBlend;
    m.alpha = alpha;
    return m;
}

gpu::Material pane(gpu::vec3 tint, float transmission, float specular, float ior)
{
    gpu::Material m = plainMaterial();
    m.flags = gpu::kMaterialThin;
    m.base_color = tint;
    m.transmission = transmission;
    m.roughness = 0;
    m.specular = specular;
    m.specular_color = {1, 1, 1};
    m.ior = ior;
    return m;
}

double square(double x)
{
    return x * x;
}

/// Reflectance of a dielectric boundary under `cosine`, by the amplitudes' formulas.
double fresnel(double cosine, double ior)
{
    const double refracted = std::sqrt(1 - (1 - cosine * cosine) / square(ior));
    const double s = (cosine - ior * refracted) / (cosine + ior * refracted);
    const double p = (refracted - ior * cosine) / (refracted + ior * cosine);
    return (s * s + p * p) / 2;
}

/// What of light crosses a surface that faces +-z: 1 - coverage x (1 - what the pane of the rest transmits).
std::array<double, 3> crossed(const gpu::Material& m, double cosine)
{
    double coverage = (m.flags & gpu::kMaterialAlphaBlend) ? m.alpha : 1;
    if (m.flags & gpu::kMaterialAlphaMask)
        coverage = m.alpha >= m.alpha_cutoff ? 1 : 0;
    double enters = 0;
    if (m.flags & gpu::kMaterialThin)
    {
        const double normal = square((double(m.ior) - 1) / (double(m.ior) + 1)),
                     f0 = std::min(normal * m.specular_color.x, 1.0) * m.specular;
        enters = (1 - (f0 + (m.specular - f0) * (fresnel(cosine, m.ior) - normal) / (1 - normal))) * m.transmission;
    }
    const auto channel = [&](double tint) { return 1 - coverage * (1 - enters * tint); };
    return {channel(m.base_color.x), channel(m.base_color.y), channel(m.base_color.z)};
}

TEST_F(Rays, CrossTranslucentLayersWithTheProductOfWhatEachLetsThrough)
{
    gpu::Material holes = blend(0.4f), no_holes = blend(0.6f);
    holes.flags = no_holes.flags = gpu::kMaterialAlphaMask;
    gpu::Material tinted_blend = pane({0.5f, 1, 0.25f}, 1, 1, 1.5f);
    tinted_blend.flags |= gpu::kMaterialAlphaBlend;
    tinted_blend.alpha = 0.5f;
    const std::vector<gpu::Material> materials{blend(0.3f),
                                               blend(0),
                                               blend(0.95f),
                                               holes,
                                               no_holes,
                                               tinted_blend,
                                               plainMaterial(),
                                               pane({1, 0.5f, 0.25f}, 1, 0, 1.5f),
                                               pane({0.9f, 0.8f, 0.7f}, 0.75f, 1, 1.5f),
                                               pane({1, 1, 1}, 1, 0.5f, 1.2f)};
    TriangleScene builder;
    Random random(5);
    for (const gpu::Material& m : materials)
        builder.material(m);
    constexpr uint32_t kLayers = 60; // small ones side by side: a ray crosses several, in every combination
    for (uint32_t i = 0; i < kLayers; ++i)
        builder.quad({random.between(-2, 1), random.between(-2, 1), 1 + 0.05f * float(i)},
                     {random.between(0.3f, 1.2f), 0, 0}, {0, random.between(0.3f, 1.2f), 0},
                     1 + i % uint32_t(materials.size()));
    const LoadedScene scene = builder.load(device());
    const auto triangles = scene.package.bvhTriangles();

    std::vector<gpu::Ray> rays;
    for (uint32_t i = 0; i < 20000; ++i)
    {
        const gpu::vec3 from = random.inBox({-2, -2, 0}, {2, 2, 0.5f}), to = random.inBox({-2, -2, 4.2f}, {2, 2, 5});
        const bool up = i % 2 == 0;
        rays.push_back({.origin = up ? from : to,
                        .t_max = i % 3 ? kFar : random.between(0.5f, 4),
                        .direction = up ? directionTo(to, from) : directionTo(from, to),
                        .path = i});
    }
    const std::vector<gpu::vec3> arrived = visible(scene, rays, {1, 1, 1}, {0, 0, 0});
    uint32_t compared = 0, partial = 0;
    for (size_t i = 0; i < rays.size() && !HasFailure(); ++i)
    {
        std::array<double, 3> product{1, 1, 1};
        std::map<uint32_t, const Meeting*> layers; // by triangle: splits may store one several times
        const std::vector<Meeting> all = meetings(rays[i], triangles);
        if (!std::ranges::all_of(all, [](const Meeting& m) { return m.certain && !m.ends_on_it; }))
            continue;
        for (const Meeting& m : all)
            layers[triangles[m.slot].triangle] = &m;
        for (const auto& [triangle, m] : layers)
        {
            const auto through =
                crossed(scene.package.materials()[triangles[m->slot].material], std::abs(double(rays[i].direction.z)));
            for (size_t k = 0; k < 3; ++k)
                product[k] *= through[k];
        }
        constexpr double kTolerance = 1e-5; // 60 factors at most, each some roundings of 6e-8
        EXPECT_NEAR(arrived[i].x, product[0], kTolerance) << i;
        EXPECT_NEAR(arrived[i].y, product[1], kTolerance) << i;
        EXPECT_NEAR(arrived[i].z, product[2], kTolerance) << i;
        ++compared;
        partial += product[0] > 0 && product[0] < 1;
    }
    EXPECT_GT(compared, rays.size() * 9 / 10);
    EXPECT_GT(partial, rays.size() / 5);
}

TEST_F(Rays, MeetABlendedSurfaceAsOftenAsItsAlphaSays)
{
    TriangleScene builder;
    constexpr float kFirst = 0.3f, kSecond = 0.6f;
    const std::array<uint32_t, 3> kinds{builder.material(blend(kFirst)), builder.material(blend(kSecond)), 0};
    for (uint32_t i = 0; i < 3; ++i)
        builder.quad({-1, -1, float(i + 1)}, {2, 0, 0}, {0, 2, 0}, kinds[i]);
    const LoadedScene scene = builder.load(device());
    constexpr uint32_t kCount = 100000;
    std::vector<gpu::Ray> rays;
    for (uint32_t i = 0; i < kCount; ++i)
        rays.push_back({.origin = {0.5f, 0.25f, 0}, .t_max = kFar, .direction = {0, 0, 1}, .path = i});
    const auto depths = [&](uint32_t seed)
    {
        std::vector<uint32_t> layers;
        for (const gpu::Hit& hit : closest(scene, rays, seed))
            layers.push_back(uint32_t(hit.t) - 1);
        return layers;
    };
    const std::vector<uint32_t> one = depths(1), other = depths(2);
    EXPECT_EQ(one, depths(1));
    const std::array<double, 3> probability{kFirst, (1 - kFirst) * kSecond, (1 - kFirst) * (1 - kSecond)};
    double equal_by_chance = 0, equal = 0;
    for (uint32_t layer = 0; layer < 3; ++layer)
    {
        const double p = probability[layer];
        constexpr double kSigmas = 5;
        for (const auto& found : {one, other})
            EXPECT_NEAR(double(std::ranges::count(found, layer)), kCount * p, kSigmas * std::sqrt(kCount * p * (1 - p)))
                << layer;
        equal_by_chance += p * p;
    }
    for (uint32_t i = 0; i < kCount; ++i)
        equal += one[i] == other[i];
    EXPECT_NEAR(equal, kCount * equal_by_chance,
                5 * std::sqrt(kCount * equal_by_chance * (1 - equal_by_chance))); // independent
}

/// Rays along +z from a few places below the unit square.
std::vector<gpu::Ray> raysUp(uint32_t count)
{
    Random random(13);
    std::vector<gpu::Ray> rays;
    for (uint32_t i = 0; i < count; ++i)
        rays.push_back({.origin = random.inBox({0.1f, 0.1f, -1}, {0.9f, 0.9f, 0}),
                        .t_max = kFar,
                        .direction = {0, 0, 1},
                        .path = i});
    return rays;
}

TEST_F(Rays, MeetADecalAndThroughItsHolesTheWallInOnePlane)
{
    for (const bool decal_first : {true, false})
        for (const float alpha : {0.0f, 0.3f})
            for (const uint32_t flag : {gpu::kMaterialAlphaMask, gpu::kMaterialAlphaBlend})
            {
                TriangleScene builder;
                gpu::Material m = blend(alpha);
                m.flags = flag;
                m.alpha_cutoff = 0.5f;
                const uint32_t decal = builder.material(m);
                for (const bool wall : {!decal_first, decal_first})
                    builder.quad({wall ? -1.0f : 0.0f, wall ? -0.5f : 0.0f, 1}, {wall ? 2.5f : 1.0f, 0, 0},
                                 {0, wall ? 2.0f : 1.0f, 0}, wall ? 0 : decal);
                builder.quad({-1, -1, 2}, {3, 0, 0}, {0, 3, 0}); // never seen
                const LoadedScene scene = builder.load(device());
                for (const gpu::Hit& hit : closest(scene, raysUp(64)))
                {
                    const bool is_decal = scene.package.bvhTriangles()[hit.slot].material == decal;
                    EXPECT_NEAR(scene.package.bvhTriangles()[hit.slot].v0.z, 1, 0) << "decal first: " << decal_first;
                    EXPECT_FALSE(is_decal && (alpha == 0 || flag == gpu::kMaterialAlphaMask))
                        << "decal first: " << decal_first;
                }
            }
}

/// Layers of squares one behind the other, or all in one plane, before an opaque wall.
TEST_F(Rays, CrossThousandsOfLayers)
{
    struct Stack
    {
        uint32_t layers;
        float spacing, alpha;
    };
    for (const auto& [layers, spacing, alpha] :
         {Stack{3000, 1e-3f, 0}, Stack{3000, 1e-3f, 1e-3f}, Stack{3000, 0, 0}, Stack{300, 0, 0.01f}})
    {
        TriangleScene builder;
        const uint32_t layer = builder.material(blend(alpha));
        for (uint32_t i = 0; i < layers; ++i)
            builder.quad({0, 0, 1 + spacing * float(i)}, {1, 0, 0}, {0, 1, 0}, layer);
        builder.quad({-1, -1, 8}, {3, 0, 0}, {0, 3, 0});
        const LoadedScene scene = builder.load(device());
        std::vector<gpu::Ray> rays = raysUp(512);
        uint32_t through = 0;
        for (const gpu::Hit& hit : closest(scene, rays))
        {
            ASSERT_LT(hit.slot, scene.package.bvhTriangles().size());
            through += scene.package.bvhTriangles()[hit.slot].material == 0;
        }
        const double share = std::pow(1 - double(alpha), layers), count = double(rays.size());
        EXPECT_NEAR(through, count * share, 4 * std::sqrt(count * share * (1 - share))) << layers << " " << spacing;
        for (const gpu::vec3& arrived : visible(scene, rays, {1, 1, 1}, {0, 0, 0}))
            EXPECT_EQ(arrived.x, 0);
        for (gpu::Ray& ray : rays)
            ray.t_max = 6.5f;
        constexpr double kTolerance = 3000 * 0x1p-23; // a rounding or two a layer
        for (const gpu::vec3& arrived : visible(scene, rays, {1, 1, 1}, {0, 0, 0}))
            EXPECT_NEAR(arrived.x, share, kTolerance);
    }
}

// ---- Queues --------------------------------------------------------------------------------------------------------

TEST_F(Rays, QueuesAreDispatchedInWholeGroups)
{
    const LoadedScene scene = []
    {
        TriangleScene s;
        s.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        return s.load(device());
    }();
    const RayStage stage(device(), *scene.gpu);
    for (const uint32_t count : {0u, 1u, 63u, 64u, 65u, 4095u, 4096u, 4097u, 1u << 24, (1u << 26) - 1})
    {
        gpu::QueueSize made{.count = count, .groups = {}};
        std::ranges::fill(made.groups, gpu::uvec3{77, 77, 77});
        const Buffer closed = device().upload<gpu::QueueSize>("test.closed", std::span(&made, 1));
        const Buffer resized = device().upload<gpu::QueueSize>("test.resized", std::span(&made, 1));
        Recorder rec(device());
        rec.begin(scene.gpu->descriptorSet());
        stage.close(rec, closed);
        stage.resize(rec, resized, count);
        rec.submitAndWait();
        for (const Buffer* buffer : {&closed, &resized})
        {
            const auto size = device().download<gpu::QueueSize>(*buffer, 1)[0];
            EXPECT_EQ(size.count, count);
            expectGroups(size);
        }
    }
}

TEST_F(Rays, BeyondTheQueuesCountAreLeftAlone)
{
    TriangleScene builder;
    builder.quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0});
    const LoadedScene scene = builder.load(device());
    const RayStage stage(device(), *scene.gpu);
    constexpr uint32_t kCapacity = 200, kCount = 70; // ends within a group
    const std::vector<gpu::Ray> rays(kCapacity,
                                     {.origin = {0.5f, 0.25f, 0}, .t_max = kFar, .direction = {0, 0, 1}, .path = 0});
    RayQueue queue(device(), "test.queue", 1);
    queue.rays = device().uploadTexels<gpu::Ray>("test.rays", rays);
    const Buffer hits = device().array<gpu::Hit>("test.hits", kCapacity);
    Recorder rec(device());
    rec.begin(scene.gpu->descriptorSet());
    rec.fill(hits, 0xabcdabcd);
    stage.resize(rec, queue.size, kCount);
    stage.closest(rec, queue, hits, 0);
    rec.submitAndWait();
    const auto found = device().download<gpu::Hit>(hits, kCapacity);
    for (uint32_t i = 0; i < kCapacity; ++i)
        EXPECT_EQ(found[i].slot == 0xabcdabcd, i >= kCount) << i;
}
} // namespace
