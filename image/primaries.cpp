#include "image/primaries.h"

#include <cmath>

namespace
{
using Vector3 = std::array<double, 3>;

Vector3 operator*(const Matrix3& m, const Vector3& v)
{
    return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
            m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

Matrix3 operator*(const Matrix3& a, const Matrix3& b)
{
    Matrix3 product{};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            for (int i = 0; i < 3; ++i)
                product[3 * row + column] += a[3 * row + i] * b[3 * i + column];
    return product;
}

Matrix3 scaledColumns(const Matrix3& m, const Vector3& scale)
{
    Matrix3 scaled = m;
    for (int i = 0; i < 9; ++i)
        scaled[i] *= scale[i % 3];
    return scaled;
}

std::optional<Matrix3> inverse(const Matrix3& m)
{
    const Matrix3 adjugate{m[4] * m[8] - m[5] * m[7], m[2] * m[7] - m[1] * m[8], m[1] * m[5] - m[2] * m[4],
                           m[5] * m[6] - m[3] * m[8], m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
                           m[3] * m[7] - m[4] * m[6], m[1] * m[6] - m[0] * m[7], m[0] * m[4] - m[1] * m[3]};
    const double determinant = m[0] * adjugate[0] + m[1] * adjugate[3] + m[2] * adjugate[6];
    if (!(std::abs(determinant) > 1e-6)) // three primaries all but on one line
        return std::nullopt;
    Matrix3 result = adjugate;
    for (double& entry : result)
        entry /= determinant;
    return result;
}

Vector3 whitePoint(const Primaries& p)
{
    return {p.white[0] / p.white[1], 1, (1 - p.white[0] - p.white[1]) / p.white[1]};
}

bool near(const Primaries& a, const Primaries& b)
{
    constexpr double kStated = 6e-4; // 0.3127 0.3290 is also written 0.313 0.329 and 0.312713 0.329016
    const auto close = [](const auto& p, const auto& q)
    { return std::abs(p[0] - q[0]) < kStated && std::abs(p[1] - q[1]) < kStated; };
    return close(a.red, b.red) && close(a.green, b.green) && close(a.blue, b.blue) && close(a.white, b.white);
}

/// Cone responses of XYZ.
constexpr Matrix3 kBradford{0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
} // namespace

std::optional<Matrix3> toXyz(const Primaries& p)
{
    for (const auto& point : {p.red, p.green, p.blue, p.white})
        for (const double coordinate : point)
            if (!(std::abs(coordinate) <= 10)) // not finite, or no chromaticity
                return std::nullopt;
    if (!(p.white[1] > 1e-3))
        return std::nullopt;
    const Matrix3 columns{p.red[0],
                          p.green[0],
                          p.blue[0],
                          p.red[1],
                          p.green[1],
                          p.blue[1],
                          1 - p.red[0] - p.red[1],
                          1 - p.green[0] - p.green[1],
                          1 - p.blue[0] - p.blue[1]};
    const std::optional<Matrix3> amounts = inverse(columns);
    if (!amounts)
        return std::nullopt;
    return scaledColumns(columns, *amounts * whitePoint(p));
}

std::optional<Matrix3> toRec709(const Primaries& primaries)
{
    const Primaries target;
    if (near(primaries, target))
        return kIdentity3;
    const std::optional<Matrix3> from = toXyz(primaries);
    if (!from)
        return std::nullopt;
    const Matrix3 to = *inverse(*toXyz(target));
    if (near(primaries, kXyzPrimaries))
        return to * *from;
    const Vector3 cones_from = kBradford * whitePoint(primaries);
    const Vector3 cones_to = kBradford * whitePoint(target);
    for (const double response : cones_from)
        if (!(response > 1e-3)) // not a possible white
            return std::nullopt;
    const Vector3 gain{cones_to[0] / cones_from[0], cones_to[1] / cones_from[1], cones_to[2] / cones_from[2]};
    return to * (*inverse(kBradford) * (scaledColumns(kIdentity3, gain) * kBradford)) * *from;
}
