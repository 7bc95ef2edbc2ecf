#include "format/keyframes.h"

#include "format/check.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace package
{
namespace
{
using lumicut::fb::Interpolation;

/// One of no length becomes the identity.
void normalize(std::span<double> quaternion)
{
    double square = 0;
    for (const double q : quaternion)
        square += q * q;
    const double length = std::sqrt(square);
    if (!(length > 0) || !std::isfinite(length))
    {
        std::fill(quaternion.begin(), quaternion.end(), 0.0);
        quaternion.back() = 1;
        return;
    }
    for (double& q : quaternion)
        q /= length;
}

std::array<double, 4> unitQuaternion(std::span<const float> values)
{
    std::array<double, 4> q;
    std::copy(values.begin(), values.end(), q.begin());
    normalize(q);
    return q;
}

/// Spherical linear interpolation, the shorter way; almost equal ones along the chord, which differs by less than rounding.
void slerp(std::span<const float> from, std::span<const float> to, double t, std::span<double> out)
{
    constexpr double kAlmostEqual = 1 - 1e-12; // cosine of the angle between them
    const std::array<double, 4> a = unitQuaternion(from), b = unitQuaternion(to);
    double cosine = 0;
    for (size_t i = 0; i < 4; ++i)
        cosine += a[i] * b[i];
    const double sign = cosine < 0 ? -1 : 1;
    cosine = std::fabs(cosine);
    double of_a = 1 - t, of_b = t;
    if (cosine < kAlmostEqual)
    {
        const double angle = std::acos(cosine);
        of_a = std::sin(angle * (1 - t)) / std::sin(angle);
        of_b = std::sin(angle * t) / std::sin(angle);
    }
    for (size_t i = 0; i < 4; ++i)
        out[i] = of_a * a[i] + sign * of_b * b[i];
}
} // namespace

void sampleKeyframes(const Keyframes& keys, double seconds, std::span<double> out)
{
    const bool cubic = keys.interpolation == Interpolation::CubicSpline;
    const size_t n = out.size();
    const size_t stride = cubic ? 3 * n : n; // values a key
    check(!keys.times.empty() && keys.values.size() == keys.times.size() * stride && (!keys.rotation || n == 4),
          "{} times, {} values, {} of a property", keys.times.size(), keys.values.size(), n);
    const auto value = [&](size_t key) { return keys.values.subspan(key * stride + (cubic ? n : 0), n); };
    const auto after = size_t(
        std::upper_bound(keys.times.begin(), keys.times.end(), seconds, [](double s, float time) { return s < time; }) -
        keys.times.begin());
    const size_t key = after == 0 ? 0 : after - 1;
    if (after == 0 || after == keys.times.size() || keys.interpolation == Interpolation::Step)
        std::copy(value(key).begin(), value(key).end(), out.begin());
    else
    {
        const double start = keys.times[key], length = keys.times[after] - start;
        const double t = (seconds - start) / length;
        const auto from = value(key), to = value(after);
        if (cubic)
        {
            const auto leaving = keys.values.subspan(key * stride + 2 * n, n);
            const auto arriving = keys.values.subspan(after * stride, n);
            const double t2 = t * t, t3 = t2 * t;
            for (size_t i = 0; i < n; ++i)
                out[i] = (2 * t3 - 3 * t2 + 1) * from[i] + length * (t3 - 2 * t2 + t) * leaving[i] +
                         (3 * t2 - 2 * t3) * to[i] + length * (t3 - t2) * arriving[i];
        }
        else if (keys.rotation)
            slerp(from, to, t, out);
        else
            for (size_t i = 0; i < n; ++i)
                out[i] = (1 - t) * from[i] + t * to[i];
    }
    if (keys.rotation)
        normalize(out);
}
} // namespace package
