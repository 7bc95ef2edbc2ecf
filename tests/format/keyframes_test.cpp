// Interpolation of keys against closed forms.
#include "format/keyframes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace
{
using lumicut::fb::Interpolation;
using package::Keyframes;

double sampleOne(const Keyframes& keys, double seconds)
{
    double value = 0;
    package::sampleKeyframes(keys, seconds, {&value, 1});
    return value;
}

std::array<double, 4> sampleRotation(const Keyframes& keys, double seconds)
{
    std::array<double, 4> q{};
    package::sampleKeyframes(keys, seconds, q);
    return q;
}

const std::vector<float> kTimes{1, 2, 4};

TEST(Keyframes, StepHoldsEachValueUntilTheNextKey)
{
    const std::vector<float> values{3, 5, -1};
    const Keyframes keys{kTimes, values, Interpolation::Step};
    for (const auto& [seconds, want] :
         {std::pair(0.0, 3.0), {1.0, 3.0}, {1.999, 3.0}, {2.0, 5.0}, {3.9, 5.0}, {4.0, -1.0}, {9.0, -1.0}})
        EXPECT_EQ(sampleOne(keys, seconds), want) << seconds;
}

TEST(Keyframes, LinearFollowsTheChord)
{
    const std::vector<float> values{3, 5, -1};
    const Keyframes keys{kTimes, values, Interpolation::Linear};
    for (const auto& [seconds, want] :
         {std::pair(0.0, 3.0), {1.0, 3.0}, {1.25, 3.5}, {2.0, 5.0}, {3.0, 2.0}, {4.0, -1.0}, {9.0, -1.0}})
        EXPECT_DOUBLE_EQ(sampleOne(keys, seconds), want) << seconds;
}

TEST(Keyframes, CubicSplineIsExactForCubics)
{
    const auto value = [](double t) { return 0.5 * t * t * t - 2 * t * t + t + 1; };
    const auto slope = [](double t) { return 1.5 * t * t - 4 * t + 1; };
    std::vector<float> values;
    for (const float t : kTimes)
        values.insert(values.end(), {float(slope(t)), float(value(t)), float(slope(t))});
    const Keyframes keys{kTimes, values, Interpolation::CubicSpline};
    for (double t = 1; t <= 4; t += 0.125)
        EXPECT_NEAR(sampleOne(keys, t), value(t), 1e-12) << t;
    EXPECT_EQ(sampleOne(keys, 0.5), value(1));
    EXPECT_EQ(sampleOne(keys, 5), value(4));
}

TEST(Keyframes, RotationsTurnEvenlyTheShorterWay)
{
    const double half = std::numbers::pi / 6; // of 60 degrees
    const auto s = float(std::sin(half)), c = float(std::cos(half));
    const std::vector<float> times{0, 1};
    for (const float sign : {1.0f, -1.0f}) // both are the same rotation
    {
        const std::vector<float> values{0, 0, 0, 1, 0, sign * s, 0, sign * c};
        const Keyframes keys{times, values, Interpolation::Linear, true};
        for (double t = 0; t <= 1; t += 0.125)
        {
            const auto q = sampleRotation(keys, t);
            // A rotation and its negative are one; the first key decides which comes out.
            const double flip = t == 1 ? sign : 1;
            EXPECT_NEAR(q[1], flip * std::sin(half * t), 1e-7) << sign << " " << t;
            EXPECT_NEAR(q[3], flip * std::cos(half * t), 1e-7) << sign << " " << t;
        }
    }
}

TEST(Keyframes, AlmostEqualRotationsStayUnit)
{
    const std::vector<float> times{0, 1};
    const std::vector<float> values{0, 0, 0, 1, 1e-7f, 0, 0, 1};
    const auto q = sampleRotation({times, values, Interpolation::Linear, true}, 0.5);
    EXPECT_NEAR(q[0], 0.5e-7, 1e-14);
    EXPECT_NEAR(q[3], 1, 1e-14);
}

TEST(Keyframes, RotationsAreNormalized)
{
    const std::vector<float> times{0, 2};
    const std::vector<float> spline{0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0};
    for (double t = 0; t < 2; t += 0.25)
    {
        const auto q = sampleRotation({times, spline, Interpolation::CubicSpline, true}, t);
        EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-12) << t;
        const double blend = (3 - t) * t * t / 4; // between the keys, whose tangents are 0
        EXPECT_NEAR(q[2] / q[3], blend / (1 - blend), 1e-9 * blend / (1 - blend) + 1e-12) << t;
    }
    const std::vector<float> one{0};
    const std::vector<float> none{0, 0, 0, 0};
    EXPECT_EQ(sampleRotation({one, none, Interpolation::Step, true}, 1), (std::array<double, 4>{0, 0, 0, 1}));
}
} // namespace
