// Rays for tests: random ones, and the traversal's results for them.
#pragma once
#include "runtime/camera.h"
#include "runtime/stages/rays.h"
#include "tests/stages/gpu_test.h"
#include "tests/stages/triangle_scene.h"

#include <algorithm>
#include <cmath>
#include <random>

inline constexpr float kFar = 3e38f; // kInfinity of the shaders

inline gpu::vec3 lerp(gpu::vec3 a, gpu::vec3 b, float t)
{
    return a + t * (b + -1.0f * a);
}

/// Unit vector; +z where the two points are one.
inline gpu::vec3 directionTo(gpu::vec3 to, gpu::vec3 from)
{
    const double x = double(to.x) - from.x, y = double(to.y) - from.y, z = double(to.z) - from.z,
                 l = std::sqrt(x * x + y * y + z * z);
    return l > 0 ? gpu::vec3{float(x / l), float(y / l), float(z / l)} : gpu::vec3{0, 0, 1};
}

/// Random numbers of one test: the same in every run.
class Random
{
public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    float unit() { return std::uniform_real_distribution<float>(0, 1)(engine_); }
    float between(float low, float high) { return low + (high - low) * unit(); }
    uint32_t below(uint32_t count) { return std::uniform_int_distribution<uint32_t>(0, count - 1)(engine_); }
    gpu::vec3 inBox(gpu::vec3 low, gpu::vec3 high)
    {
        return {between(low.x, high.x), between(low.y, high.y), between(low.z, high.z)};
    }
    gpu::vec3 direction()
    {
        std::normal_distribution<double> normal;
        const double x = normal(engine_), y = normal(engine_), z = normal(engine_),
                     l = std::sqrt(x * x + y * y + z * z);
        return {float(x / l), float(y / l), float(z / l)};
    }
    gpu::vec3 onTriangle(const gpu::BvhTriangle& t)
    {
        const float r = std::sqrt(unit()), s = unit();
        return lerp(t.v0, lerp(t.v1, t.v2, s), r);
    }

private:
    std::mt19937 engine_;
};

class Rays : public GpuTest
{
protected:
    static std::vector<gpu::Hit> closest(const LoadedScene& scene, std::span<const gpu::Ray> rays, uint32_t seed = 1)
    {
        const RayStage stage(device(), *scene.gpu);
        const uint32_t count = uint32_t(rays.size());
        RayQueue queue(device(), "test.queue", 1);
        queue.rays = device().uploadTexels("test.rays", rays);
        const Buffer hits = device().array<gpu::Hit>("test.hits", count);
        Recorder rec(device());
        rec.begin(scene.gpu->descriptorSet());
        stage.resize(rec, queue.size, count);
        stage.closest(rec, queue, hits, seed);
        rec.submitAndWait();
        return device().download<gpu::Hit>(hits, count);
    }

    /// What of `light` arrives along each ray, on top of `before`.
    static std::vector<gpu::vec3> visible(const LoadedScene& scene, std::span<const gpu::Ray> rays, gpu::vec3 light,
                                          gpu::vec3 before)
    {
        const RayStage stage(device(), *scene.gpu);
        const uint32_t count = uint32_t(rays.size());
        std::vector<gpu::ShadowRay> shadow_rays;
        for (uint32_t i = 0; i < count; ++i)
        {
            shadow_rays.push_back({.ray = rays[i], .radiance = light, .unused = 0});
            shadow_rays.back().ray.path = count - 1 - i; // any one-to-one mapping will do
        }
        const std::vector<gpu::vec3> start(count, before);
        const Buffer size = device().array<gpu::QueueSize>("test.size", 1);
        const Buffer queue = device().uploadTexels<gpu::ShadowRay>("test.shadow_rays", shadow_rays);
        const Buffer radiance = device().upload<gpu::vec3>("test.radiance", start);
        Recorder rec(device());
        rec.begin(scene.gpu->descriptorSet());
        stage.resize(rec, size, count);
        stage.visible(rec, size, queue, radiance);
        rec.submitAndWait();
        std::vector<gpu::vec3> arrived = device().download<gpu::vec3>(radiance, count);
        std::ranges::reverse(arrived);
        return arrived;
    }
};
