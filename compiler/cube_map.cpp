#include "compiler/cube_map.h"

#include "compiler/environment_map.h"
#include "compiler/parallel.h"
#include "format/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace
{
using Vector3 = std::array<double, 3>;

/// A face as it is seen from the cube's middle: the axis through it and those that run right and down in the picture.
struct Face
{
    Vector3 forward, right, down;
};

constexpr std::array<Face, 6> kFaces{{{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                      {{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                      {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
                                      {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                                      {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}},
                                      {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}}}};

double dot(const Vector3& a, const Vector3& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Bilinear within the face that `d` points at. The outermost pixels' centres lie on the face's edges.
std::array<double, 3> lookUp(const EnvironmentImage& cube, const Vector3& d)
{
    const auto reach = [&](const Face& face) { return dot(face.forward, d); };
    const size_t face = size_t(std::ranges::max_element(kFaces, {}, reach) - kFaces.begin());
    const double forward = reach(kFaces[face]), last = cube.width - 1.0;
    const double x = std::clamp((dot(kFaces[face].right, d) / forward + 1) / 2, 0.0, 1.0) * last;
    const double y = std::clamp((dot(kFaces[face].down, d) / forward + 1) / 2, 0.0, 1.0) * last;
    const double left = std::floor(x), top = std::floor(y);
    std::array<double, 3> sum{};
    for (const double right : {0.0, 1.0})
        for (const double down : {0.0, 1.0})
        {
            const double weight = (right == 0 ? 1 - (x - left) : x - left) * (down == 0 ? 1 - (y - top) : y - top);
            const double column = std::min(left + right, last), row = std::min(top + down, last);
            const gpu::vec4& texel = cube.texels[(face * cube.width + size_t(row)) * cube.width + size_t(column)];
            sum[0] += weight * texel.x;
            sum[1] += weight * texel.y;
            sum[2] += weight * texel.z;
        }
    return sum;
}
} // namespace

EnvironmentImage toEquirectangular(const EnvironmentImage& cube)
{
    check(cube.width > 0 && cube.height == 6 * cube.width, "a cube of {} x {}", cube.width, cube.height);
    constexpr int kSamples = 2; // a texel each way
    EnvironmentImage map{.width = std::min(4 * cube.width, kMaxEnvironmentWidth), .height = 0, .texels = {}};
    map.height = map.width / 2;
    map.texels.resize(size_t(map.width) * map.height);
    parallelFor(
        map.height,
        [&](size_t row)
        {
            for (uint32_t column = 0; column < map.width; ++column)
            {
                std::array<double, 3> sum{};
                for (int i = 0; i < kSamples * kSamples; ++i)
                {
                    const double u = (column + (i % kSamples + 0.5) / kSamples) / map.width;
                    const double v = (double(row) + (i / kSamples + 0.5) / kSamples) / map.height;
                    const double phi = (u - 0.5) * 2 * std::numbers::pi, theta = v * std::numbers::pi;
                    const double ring = std::sin(theta);
                    const auto rgb = lookUp(cube, {ring * std::cos(phi), std::cos(theta), ring * std::sin(phi)});
                    for (size_t c = 0; c < 3; ++c)
                        sum[c] += rgb[c] / (kSamples * kSamples);
                }
                map.texels[row * map.width + column] = {float(sum[0]), float(sum[1]), float(sum[2]), 1};
            }
        });
    return map;
}
