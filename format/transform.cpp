#include "format/transform.h"

namespace
{
/// Column-major rotation matrix of a quaternion, normalised.
std::array<double, 9> rotationMatrix(double x, double y, double z, double w)
{
    const double l = std::sqrt(x * x + y * y + z * z + w * w);
    if (!(l > 0))
        return {1, 0, 0, 0, 1, 0, 0, 0, 1};
    x /= l, y /= l, z /= l, w /= l;
    return {1 - 2 * (y * y + z * z), 2 * (x * y + z * w),     2 * (x * z - y * w),
            2 * (x * y - z * w),     1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
            2 * (x * z + y * w),     2 * (y * z - x * w),     1 - 2 * (x * x + y * y)};
}
} // namespace

Transform fromTranslationRotationScale(const std::array<double, 3>& t, const std::array<double, 4>& r,
                                       const std::array<double, 3>& s)
{
    Transform result{rotationMatrix(r[0], r[1], r[2], r[3]), t};
    for (size_t i = 0; i < 9; ++i)
        result.linear[i] *= s[i / 3];
    return result;
}
