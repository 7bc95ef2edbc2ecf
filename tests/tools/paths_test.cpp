// How cameras move in measurements.
#include "tools/bench/paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace
{
constexpr float kDegree = std::numbers::pi_v<float> / 180;

float length(gpu::vec3 v)
{
    return std::sqrt(dot(v, v));
}
} // namespace

TEST(PathsTest, AnOrbitKeepsItsCentreInViewAtOneDistance)
{
    const Camera camera{.position = {1, 2, 3}, .forward = normalize({1, -0.5f, -1}), .up = normalize({1, 4, -1})};
    const gpu::vec3 center = camera.position + 2.5f * camera.forward;
    for (const float radius : {2.5f, -2.5f})
        for (const float seconds : {-0.3f, 0.0f, 0.5f, 4.0f})
        {
            const Camera moved = orbitingCamera(camera, radius, seconds);
            EXPECT_NEAR(length(center + -1 * (moved.position + 2.5f * moved.forward)), 0, 1e-5f);
            EXPECT_NEAR(length(moved.forward), 1, 1e-6f);
            EXPECT_NEAR(dot(moved.forward, moved.up), 0, 1e-6f);
            EXPECT_NEAR(dot(moved.forward, camera.forward), std::cos(20 * kDegree * seconds), 1e-5f);
        }
    EXPECT_NEAR(length(orbitingCamera(camera, 2.5f, 0).position + -1 * camera.position), 0, 1e-6f);
}

TEST(PathsTest, AnOrbitGoesToTheSideOfItsSign)
{
    const Camera camera{};
    EXPECT_GT(orbitingCamera(camera, 3, 0.1f).position.x, 0.01f); // +x is right of -z
    EXPECT_LT(orbitingCamera(camera, -3, 0.1f).position.x, -0.01f);
}

TEST(PathsTest, AnOrbitIsHalfAsWideAsTheViewIsDeepAndFitsTheRoom)
{
    EXPECT_FLOAT_EQ(orbitRadius(8, 100, 100), 4);
    EXPECT_FLOAT_EQ(orbitRadius(8, 2, 1), -1.8f);
    EXPECT_FLOAT_EQ(orbitRadius(8, 1, 2), 1.8f);
    EXPECT_FLOAT_EQ(orbitRadius(8, 1, INFINITY), 4);
}

TEST(PathsTest, SwayingBeginsAtTheGivenView)
{
    const gpu::SceneInfo info{.bounds_min = {-10, -10, -10}, .bounds_max = {10, 10, 10}};
    const Camera camera{.position = {1, 2, 3}};
    const Camera still = movedCamera(camera, info, 0), moved = movedCamera(camera, info, 0.5f);
    EXPECT_EQ(still.position.x, 1);
    EXPECT_EQ(still.forward.x, camera.forward.x);
    EXPECT_GT(length(moved.position + -1 * still.position), 1e-4f);
    const Camera round = movedCamera(camera, info, 120);
    EXPECT_NEAR(length(round.position + -1 * still.position), 0, 1e-5f);
}
