#include "tools/bench/reproject.h"

#include "format/check.h"

#include <algorithm>
#include <array>

namespace
{
gpu::vec3 difference(gpu::vec3 a, gpu::vec3 b)
{
    return a + -1 * b;
}

/// The four pixels whose centres are around a place, and their bilinear weights. At the border they are the nearest.
struct Neighbours
{
    std::array<size_t, 4> pixels;
    std::array<float, 4> weights;
};

Neighbours neighboursOf(PicturePoint place, uint32_t width, uint32_t height)
{
    const float left = std::floor(place.x - 0.5f), top = std::floor(place.y - 0.5f);
    const float right_weight = place.x - 0.5f - left, lower_weight = place.y - 0.5f - top;
    Neighbours result{};
    for (uint32_t i = 0; i < 4; ++i)
    {
        const bool right = (i & 1) != 0, lower = (i & 2) != 0;
        const auto column = size_t(std::clamp(left + float(right), 0.0f, float(width - 1)));
        const auto row = size_t(std::clamp(top + float(lower), 0.0f, float(height - 1)));
        result.pixels[i] = row * width + column;
        result.weights[i] = (right ? right_weight : 1 - right_weight) * (lower ? lower_weight : 1 - lower_weight);
    }
    return result;
}

bool sameSurface(const FirstHit& a, const FirstHit& b)
{
    if (a.isSky() || b.isSky())
        return a.isSky() == b.isSky();
    return std::abs(dot(a.normal, difference(b.position, a.position))) <= std::max(a.footprint, b.footprint);
}

/// Catmull and Rom's weights of the values at -1, 0, 1 and 2 for one at t in 0..1.
std::array<float, 4> cubicWeights(float t)
{
    return {0.5f * t * (t * (2 - t) - 1), 0.5f * (t * t * (3 * t - 5) + 2), 0.5f * t * (t * (4 - 3 * t) + 1),
            0.5f * t * t * (t - 1)};
}
} // namespace

gpu::Ray centerRay(const gpu::CameraParams& camera, uint32_t column, uint32_t row)
{
    const float x = 2 * (float(column) + 0.5f) / float(camera.width) - 1,
                y = 1 - 2 * (float(row) + 0.5f) / float(camera.height);
    const gpu::vec3 offset = x * camera.right + y * camera.up;
    gpu::Ray ray{camera.position, std::numeric_limits<float>::infinity(), camera.forward, row * camera.width + column};
    float per_depth = 1; // metres along the ray for one along forward
    if (camera.orthographic)
        ray.origin = ray.origin + offset;
    else
    {
        const gpu::vec3 along = camera.forward + offset;
        per_depth = std::sqrt(dot(along, along));
        ray.direction = normalize(along);
    }
    ray.origin = ray.origin + (camera.near_plane * per_depth) * ray.direction;
    if (camera.far_plane > 0)
        ray.t_max = (camera.far_plane - camera.near_plane) * per_depth;
    return ray;
}

std::vector<gpu::Ray> centerRays(const gpu::CameraParams& camera)
{
    std::vector<gpu::Ray> rays;
    rays.reserve(size_t(camera.width) * camera.height);
    for (uint32_t row = 0; row < camera.height; ++row)
        for (uint32_t column = 0; column < camera.width; ++column)
            rays.push_back(centerRay(camera, column, row));
    return rays;
}

FirstHits firstHits(const gpu::CameraParams& camera, std::span<const gpu::Hit> hits,
                    std::span<const gpu::BvhTriangle> triangles)
{
    const std::vector<gpu::Ray> rays = centerRays(camera);
    check(hits.size() == rays.size(), "{} hits of {} rays", hits.size(), rays.size());
    FirstHits result{.camera = camera, .hits = {}};
    result.hits.reserve(hits.size());
    for (size_t i = 0; i < hits.size(); ++i)
    {
        if (hits[i].slot == gpu::kNone)
        {
            result.hits.push_back({rays[i].direction, {}, 0, gpu::kNone});
            continue;
        }
        const gpu::BvhTriangle& triangle = triangles[hits[i].slot];
        const gpu::vec3 position = rays[i].origin + hits[i].t * rays[i].direction,
                        from_eye = difference(position, camera.position);
        const float distance = camera.orthographic ? 1 : std::sqrt(dot(from_eye, from_eye));
        result.hits.push_back(
            {.position = position,
             .normal = normalize(cross(difference(triangle.v1, triangle.v0), difference(triangle.v2, triangle.v0))),
             .footprint = pixelSide(camera) * distance,
             .slot = hits[i].slot});
    }
    return result;
}

PicturePoint project(const gpu::CameraParams& camera, const FirstHit& hit)
{
    const gpu::vec3 to = hit.isSky() ? hit.position : difference(hit.position, camera.position);
    const float depth = camera.orthographic ? 1 : dot(to, camera.forward);
    const float x = dot(to, camera.right) / (depth * dot(camera.right, camera.right));
    const float y = dot(to, camera.up) / (depth * dot(camera.up, camera.up));
    if (!(depth > 0) || !(std::abs(x) <= 1 && std::abs(y) <= 1))
        return {};
    return {0.5f * (x + 1) * float(camera.width), 0.5f * (1 - y) * float(camera.height)};
}

std::vector<PicturePoint> reproject(const FirstHits& now, const FirstHits& then)
{
    const uint32_t width = now.camera.width, height = now.camera.height;
    check(width == then.camera.width && height == then.camera.height, "{} x {} and {} x {}", width, height,
          then.camera.width, then.camera.height);
    std::vector<PicturePoint> places(now.hits.size());
    for (size_t i = 0; i < places.size(); ++i)
    {
        const PicturePoint place = project(then.camera, now.hits[i]);
        if (!place.isSeen())
            continue;
        const Neighbours around = neighboursOf(place, width, height);
        float same = 0;
        for (size_t n = 0; n < 4; ++n)
            same += sameSurface(now.hits[i], then.hits[around.pixels[n]]) ? around.weights[n] : 0;
        if (same >= 0.5f)
            places[i] = place;
    }
    return places;
}

ImageF warp(const ImageF& picture, std::span<const PicturePoint> places, const ImageF& unseen)
{
    check(places.size() == picture.pixelCount() && places.size() == unseen.pixelCount(),
          "{} places of {} and {} pixels", places.size(), picture.pixelCount(), unseen.pixelCount());
    ImageF result = unseen;
    for (size_t i = 0; i < places.size(); ++i)
    {
        if (!places[i].isSeen())
            continue;
        const float left = std::floor(places[i].x - 0.5f), top = std::floor(places[i].y - 0.5f);
        const auto across = cubicWeights(places[i].x - 0.5f - left), down = cubicWeights(places[i].y - 0.5f - top);
        std::array<float, 3> sum{};
        for (size_t n = 0; n < 16; ++n)
        {
            const auto column = size_t(std::clamp(left + float(n % 4) - 1, 0.0f, float(picture.width - 1)));
            const auto row = size_t(std::clamp(top + float(n / 4) - 1, 0.0f, float(picture.height - 1)));
            for (size_t channel = 0; channel < 3; ++channel)
                sum[channel] += across[n % 4] * down[n / 4] * picture.rgb[3 * (row * picture.width + column) + channel];
        }
        std::ranges::copy(sum, result.rgb.begin() + std::ptrdiff_t(3 * i));
    }
    return result;
}
