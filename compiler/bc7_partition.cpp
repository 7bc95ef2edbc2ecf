#include "compiler/bc7_line.h"

#include "format/bc7_tables.h"

namespace bc7
{
namespace
{
using Four = Lanes::Four; // one partition a lane

/// Sums over the texels of a subset: 1, r, g, b, rr, rg, rb, gg, gb, bb.
using Moments = std::array<Four, 10>;

/// [texel][four partitions]: 1 in subset 1.
const std::array<std::array<Four, 16>, 16>& membership()
{
    static const auto table = []
    {
        std::array<std::array<Four, 16>, 16> t{};
        for (size_t texel = 0; texel < 16; ++texel)
            for (size_t p = 0; p < 64; ++p)
                t[texel][p / 4][p % 4] = float(kTwoSubsets[p] >> texel & 1);
        return t;
    }();
    return table;
}

Four broadcast(float x)
{
    return Four{x, x, x, x};
}

/// The variance of a subset across its principal axis: the trace of its covariance less the largest eigenvalue, by two steps
/// of power iteration and a Rayleigh quotient.
Four residual(const Moments& m)
{
    const Four inverse = broadcast(1) / m[0];
    const Four rr = m[4] - m[1] * m[1] * inverse, rg = m[5] - m[1] * m[2] * inverse, rb = m[6] - m[1] * m[3] * inverse;
    const Four gg = m[7] - m[2] * m[2] * inverse, gb = m[8] - m[2] * m[3] * inverse, bb = m[9] - m[3] * m[3] * inverse;
    Four x = broadcast(1), y = broadcast(0.8f), z = broadcast(0.6f); // along no usual axis' normal
    for (int i = 0; i < 2; ++i)
    {
        const Four nx = rr * x + rg * y + rb * z, ny = rg * x + gg * y + gb * z, nz = rb * x + gb * y + bb * z;
        const Four scale = broadcast(1) / (rr + gg + bb + broadcast(1e-6f));
        x = nx * scale, y = ny * scale, z = nz * scale;
    }
    const Four above = rr * x * x + gg * y * y + bb * z * z + broadcast(2) * (rg * x * y + rb * x * z + gb * y * z);
    return rr + gg + bb - above / (x * x + y * y + z * z + broadcast(1e-12f));
}
} // namespace

void promisingPartitions(const std::array<Lanes, 3>& c, std::span<uint32_t> out)
{
    std::array<std::array<float, 10>, 16> texels; // moments of each
    std::array<float, 10> whole{};
    for (size_t i = 0; i < 16; ++i)
    {
        const float r = c[0][i], g = c[1][i], b = c[2][i];
        texels[i] = {1, r, g, b, r * r, r * g, r * b, g * g, g * b, b * b};
        for (size_t k = 0; k < 10; ++k)
            whole[k] += texels[i][k];
    }
    std::array<float, 64> left;
    for (size_t four = 0; four < 16; ++four)
    {
        Moments one{}, other;
        for (size_t i = 0; i < 16; ++i)
        {
            const Four in = membership()[i][four];
            for (size_t k = 0; k < 10; ++k)
                one[k] = one[k] + in * broadcast(texels[i][k]);
        }
        for (size_t k = 0; k < 10; ++k)
            other[k] = broadcast(whole[k]) - one[k];
        const Four both = residual(one) + residual(other);
        for (size_t lane = 0; lane < 4; ++lane)
            left[4 * four + lane] = both[lane];
    }
    for (uint32_t& best : out)
    {
        best = uint32_t(std::min_element(left.begin(), left.end()) - left.begin());
        left[best] = INFINITY;
    }
}
} // namespace bc7
