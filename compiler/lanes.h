// Sixteen floats side by side, one a texel of a block, in vector registers. Sums have one order everywhere, so that equal
// input gives equal bytes on every machine.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

struct Lanes
{
    using Four = float __attribute__((vector_size(16)));
    using FourInts = int32_t __attribute__((vector_size(16)));
    Four v[4];

    static Lanes all(float x)
    {
        const Four f{x, x, x, x};
        return {{f, f, f, f}};
    }
    float operator[](size_t i) const { return v[i / 4][i % 4]; }
    void set(size_t i, float x) { v[i / 4][i % 4] = x; }
};

inline Lanes operator+(const Lanes& a, const Lanes& b)
{
    return {{a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]}};
}
inline Lanes operator-(const Lanes& a, const Lanes& b)
{
    return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], a.v[3] - b.v[3]}};
}
inline Lanes operator*(const Lanes& a, const Lanes& b)
{
    return {{a.v[0] * b.v[0], a.v[1] * b.v[1], a.v[2] * b.v[2], a.v[3] * b.v[3]}};
}
inline Lanes operator+(const Lanes& a, float b)
{
    return a + Lanes::all(b);
}
inline Lanes operator-(const Lanes& a, float b)
{
    return a - Lanes::all(b);
}
inline Lanes operator*(const Lanes& a, float b)
{
    return a * Lanes::all(b);
}

inline Lanes clamp(const Lanes& a, float low, float high)
{
    const Lanes l = Lanes::all(low), h = Lanes::all(high);
    Lanes out;
    for (size_t i = 0; i < 4; ++i)
    {
        const Lanes::Four raised = a.v[i] > l.v[i] ? a.v[i] : l.v[i];
        out.v[i] = raised < h.v[i] ? raised : h.v[i];
    }
    return out;
}
/// Of numbers that are not negative: rounded to nearest.
inline Lanes rounded(const Lanes& a)
{
    Lanes out;
    for (size_t i = 0; i < 4; ++i)
    {
        const Lanes::Four half{0.5f, 0.5f, 0.5f, 0.5f};
        out.v[i] = __builtin_convertvector(__builtin_convertvector(a.v[i] + half, Lanes::FourInts), Lanes::Four);
    }
    return out;
}
inline float sum(const Lanes& a)
{
    const Lanes::Four s = (a.v[0] + a.v[1]) + (a.v[2] + a.v[3]);
    return (s[0] + s[1]) + (s[2] + s[3]);
}
inline float least(const Lanes& a)
{
    Lanes::Four s = a.v[0];
    for (size_t i = 1; i < 4; ++i)
        s = a.v[i] < s ? a.v[i] : s;
    const float x = s[0] < s[1] ? s[0] : s[1], y = s[2] < s[3] ? s[2] : s[3];
    return x < y ? x : y;
}
inline float greatest(const Lanes& a)
{
    return -least(Lanes::all(0) - a);
}
