// Reprojection and warping on geometry that is known in closed form: a wall, and a box before it.
#include "tools/bench/reproject.h"

#include <gtest/gtest.h>

#include <numbers>

namespace
{
constexpr uint32_t kWidth = 64, kHeight = 48;
constexpr float kWall = 4;    // metres from the first camera to the wall z = -4
constexpr float kBoxSide = 1; // a square 1 m before it, parallel to it, around its centre
constexpr float kBoxDistance = 3;

gpu::CameraParams cameraAt(gpu::vec3 position, float turn = 0)
{
    const Camera camera{.position = position, .forward = {std::sin(turn), 0, -std::cos(turn)}};
    return cameraParams(camera, kWidth, kHeight);
}

/// Where a ray meets the plane z = -distance.
gpu::vec3 onPlane(const gpu::Ray& ray, float distance)
{
    return ray.origin + ((-distance - ray.origin.z) / ray.direction.z) * ray.direction;
}

bool isOnBox(gpu::vec3 at)
{
    return std::abs(at.x) <= kBoxSide / 2 && std::abs(at.y) <= kBoxSide / 2;
}

/// What the camera sees of the wall, of infinite extent, and of the box where it is there.
FirstHits look(const gpu::CameraParams& camera, bool box)
{
    FirstHits result{camera, {}};
    for (const gpu::Ray& ray : centerRays(camera))
    {
        const gpu::vec3 front = onPlane(ray, kBoxDistance);
        const bool hit = box && isOnBox(front);
        const gpu::vec3 at = hit ? front : onPlane(ray, kWall), to = at + -1 * camera.position;
        result.hits.push_back({at, {0, 0, 1}, pixelSide(camera) * std::sqrt(dot(to, to)), hit ? 1u : 0u});
    }
    return result;
}

/// A texture on the wall, of 2.5 to 3.5 periods over the picture.
float texture(gpu::vec3 at)
{
    return 0.5f + 0.25f * std::sin(5 * at.x) + 0.25f * std::cos(4 * at.y + 1);
}

ImageF paint(const FirstHits& hits)
{
    ImageF image{kWidth, kHeight, {}};
    for (const FirstHit& hit : hits.hits)
        image.rgb.insert(image.rgb.end(), {texture(hit.position), 0.5f * texture(hit.position), 0.25f});
    return image;
}
} // namespace

TEST(ReprojectTest, ProjectionTakesEveryPixelsHitBackToItsCenter)
{
    for (const gpu::CameraParams& camera : {cameraAt({0, 0, 0}), cameraAt({0.3f, -0.2f, 0.5f}, 0.4f)})
    {
        const FirstHits hits = look(camera, true);
        for (uint32_t i = 0; i < hits.hits.size(); ++i)
        {
            const PicturePoint place = project(camera, hits.hits[i]);
            // Rounding: a few parts in 2^23 of coordinates up to 64.
            EXPECT_NEAR(place.x, float(i % kWidth) + 0.5f, 1e-4f) << i;
            EXPECT_NEAR(place.y, float(i / kWidth) + 0.5f, 1e-4f) << i;
        }
    }
}

TEST(ReprojectTest, OrthographicRaysAreParallelAndComeBack)
{
    const Camera camera{.position = {0, 0, 1}, .orthographic_height = 3, .near_plane = 0.5f, .far_plane = 9};
    const gpu::CameraParams params = cameraParams(camera, kWidth, kHeight);
    const gpu::Ray ray = centerRay(params, 0, 0);
    EXPECT_FLOAT_EQ(ray.origin.y, 1.5f - 0.5f * 3 / kHeight);
    EXPECT_FLOAT_EQ(ray.origin.z, 0.5f);
    EXPECT_FLOAT_EQ(ray.t_max, 8.5f);
    EXPECT_FLOAT_EQ(ray.direction.z, -1);
    const PicturePoint place = project(params, {onPlane(ray, kWall), {0, 0, 1}, 0.1f, 0});
    EXPECT_NEAR(place.x, 0.5f, 1e-4f);
    EXPECT_NEAR(place.y, 0.5f, 1e-4f);
}

TEST(ReprojectTest, WhatIsBehindTheEyeOrOutsideIsNotSeen)
{
    const gpu::CameraParams camera = cameraAt({0, 0, 0});
    EXPECT_FALSE(project(camera, {{0, 0, 4}, {0, 0, 1}, 0.1f, 0}).isSeen());
    EXPECT_FALSE(project(camera, {{9, 0, -4}, {0, 0, 1}, 0.1f, 0}).isSeen());
    EXPECT_FALSE(project(camera, {{0, 0, 1}, {}, 0, gpu::kNone}).isSeen()); // sky behind
    EXPECT_TRUE(project(camera, {{0, 0, -1}, {}, 0, gpu::kNone}).isSeen());
}

TEST(ReprojectTest, WarpBringsATextureToWhereItIsNow)
{
    // Moved, turned, and nearer: no pixel falls on another.
    const FirstHits then = look(cameraAt({0, 0, 0}), false), now = look(cameraAt({0.21f, 0.13f, -0.3f}, 0.03f), false);
    const std::vector<PicturePoint> places = reproject(now, then);
    const ImageF expected = paint(now), warped = warp(paint(then), places, expected);
    double inside = 0;
    for (size_t i = 0; i < places.size(); ++i)
    {
        const bool inner = places[i].isSeen() && places[i].x > 1.5f && places[i].x < kWidth - 1.5f &&
                           places[i].y > 1.5f && places[i].y < kHeight - 1.5f;
        if (!inner)
            continue;
        ++inside;
        // Slopes by central differences are off by h^2/6 of the third derivative, which moves the cubic by
        // t (1 - t) (1 - 2t) <= 0.0963 of h times that; with true slopes it is off by h^4/384 of the fourth. Pixels are
        // h = 2 * 4 * tan(0.4) / 48 = 0.0705 m on the wall, the derivatives, over both axes, 0.25 * (5^3 + 4^3) and
        // 0.25 * (5^4 + 4^4) at most, and the weights across add up to 1.25 in magnitude: 3.6e-4, and rounding.
        EXPECT_NEAR(warped.rgb[3 * i], expected.rgb[3 * i], 4e-4f) << i;
        EXPECT_NEAR(warped.rgb[3 * i + 1], expected.rgb[3 * i + 1], 2e-4f) << i;
    }
    EXPECT_GT(inside, 0.8 * kWidth * kHeight);
}

TEST(ReprojectTest, WarpOntoTheSameViewIsTheSamePicture)
{
    const FirstHits view = look(cameraAt({0.1f, 0, 0}, 0.2f), true);
    const std::vector<PicturePoint> places = reproject(view, view);
    const ImageF picture = paint(view);
    const ImageF warped = warp(picture, places, ImageF{kWidth, kHeight, std::vector<float>(3 * kWidth * kHeight, 9)});
    for (size_t i = 0; i < picture.rgb.size(); ++i)
        EXPECT_NEAR(warped.rgb[i], picture.rgb[i], 1e-4f) << i; // places are off by rounding
}

TEST(ReprojectTest, AMovingCameraUncoversTheWallBesideABox)
{
    const gpu::vec3 before{-0.6f, 0.1f, 0};
    const FirstHits then = look(cameraAt(before), true), now = look(cameraAt({0.6f, 0, 0}), true);
    const std::vector<PicturePoint> places = reproject(now, then);
    uint32_t hidden = 0;
    for (size_t i = 0; i < places.size(); ++i)
    {
        const PicturePoint place = project(then.camera, now.hits[i]);
        if (!place.isSeen())
        {
            EXPECT_FALSE(places[i].isSeen()) << i;
            continue;
        }
        // Truth: on the wall, whether the line to the eye of before passes the box.
        const gpu::vec3 at = now.hits[i].position;
        gpu::Ray to_wall{before, 0, at + -1 * before, 0};
        const gpu::vec3 crossing = onPlane(to_wall, kBoxDistance);
        const bool covered = now.hits[i].slot == 0 && isOnBox(crossing);
        // Within half a pixel of an edge the majority of four pixels may differ.
        const float margin = 0.71f * pixelSide(then.camera) * kBoxDistance;
        const float edge = std::max(std::abs(crossing.x), std::abs(crossing.y)) - kBoxSide / 2;
        if (now.hits[i].slot == 0 && std::abs(edge) < margin)
            continue;
        if (now.hits[i].slot == 1 && std::max(std::abs(at.x), std::abs(at.y)) > kBoxSide / 2 - margin)
            continue;
        EXPECT_EQ(places[i].isSeen(), !covered) << i % kWidth << ", " << i / kWidth;
        hidden += covered;
    }
    // The box hides a square of 4/3 m, which has moved by 0.4 m or six pixels: about 110 pixels are new, half of them
    // far from an edge.
    EXPECT_GT(hidden, 50u);
}

TEST(ReprojectTest, SkyIsSeenWhereSkyWasAndNotWhereAWallWas)
{
    const gpu::CameraParams camera = cameraAt({0, 0, 0});
    FirstHits sky{camera, {}};
    for (const gpu::Ray& ray : centerRays(camera))
        sky.hits.push_back({ray.direction, {}, 0, gpu::kNone});
    const FirstHits wall = look(camera, false);
    for (const PicturePoint& place : reproject(sky, sky))
        EXPECT_TRUE(place.isSeen());
    for (const PicturePoint& place : reproject(sky, wall))
        EXPECT_FALSE(place.isSeen());
    for (const PicturePoint& place : reproject(wall, sky))
        EXPECT_FALSE(place.isSeen());
}

TEST(ReprojectTest, HitsOfRaysBecomePlacesWithTheTrianglesNormal)
{
    const gpu::CameraParams camera = cameraAt({0, 0, 0});
    const std::array triangles{gpu::BvhTriangle{{-9, -9, -4}, 0, {9, -9, -4}, 0, {0, 9, -4}, 0}};
    std::vector<gpu::Hit> hits;
    for (const gpu::Ray& ray : centerRays(camera))
        hits.push_back({-kWall / ray.direction.z, ray.path == 5 ? gpu::kNone : 0u, {}});
    const FirstHits seen = firstHits(camera, hits, triangles);
    EXPECT_TRUE(seen.hits[5].isSky());
    EXPECT_NEAR(seen.hits[5].position.z, centerRay(camera, 5, 0).direction.z, 1e-6f);
    const FirstHit center = seen.hits[kHeight / 2 * kWidth + kWidth / 2];
    EXPECT_NEAR(center.position.z, -kWall, 1e-5f);
    EXPECT_EQ(center.normal.z, 1);
    // The picture's height at 1 m is 2 tan(0.4); the pixel is half a pixel off the axis.
    EXPECT_NEAR(center.footprint, 2 * std::tan(0.4f) / kHeight * kWall, 1e-4f);
}
