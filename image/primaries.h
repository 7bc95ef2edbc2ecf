// Colours of other primaries as linear Rec. 709.
#pragma once
#include <array>
#include <optional>

/// CIE 1931 chromaticities (x, y).
struct Primaries
{
    std::array<double, 2> red{0.64, 0.33}; // Rec. 709
    std::array<double, 2> green{0.30, 0.60};
    std::array<double, 2> blue{0.15, 0.06};
    std::array<double, 2> white{0.3127, 0.3290};
};

/// Primaries whose amounts are X, Y and Z themselves.
inline constexpr Primaries kXyzPrimaries{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};

/// Row-major 3 x 3.
using Matrix3 = std::array<double, 9>;

inline constexpr Matrix3 kIdentity3{1, 0, 0, 0, 1, 0, 0, 0, 1};

/// RGB of `primaries` to XYZ with Y = 1 for (1, 1, 1); its middle row weighs luminance.
/// @return nothing where the primaries are no colour space: on one line, without white, or not finite
std::optional<Matrix3> toXyz(const Primaries& primaries);

/// RGB of `primaries` to linear Rec. 709: their white becomes white by the Bradford transform (Lam 1985; ICC.1:2010
/// annex E). XYZ is absolute, not relative to a device's white, and is not adapted.
/// @return exactly kIdentity3 for Rec. 709 itself, within the four digits that files state; nothing as toXyz()
std::optional<Matrix3> toRec709(const Primaries& primaries);

/// Replaces rgb[0..2] by matrix * rgb.
inline void transform(const Matrix3& m, float* rgb)
{
    const double r = rgb[0], g = rgb[1], b = rgb[2];
    for (int i = 0; i < 3; ++i)
        rgb[i] = float(m[3 * i] * r + m[3 * i + 1] * g + m[3 * i + 2] * b);
}
