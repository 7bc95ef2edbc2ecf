#include "runtime/frame/light_range.h"

#include "format/check.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace
{
constexpr float kEndless = std::numeric_limits<float>::max(); // of which products with 0 are 0
constexpr std::array<float gpu::vec3::*, 3> kChannels{&gpu::vec3::x, &gpu::vec3::y, &gpu::vec3::z};

struct Widened
{
    LightRange range{{kEndless, kEndless, kEndless}, {}};

    void add(gpu::vec3 before, gpu::vec3 now)
    {
        for (const auto channel : kChannels)
        {
            if (before.*channel == now.*channel && now.*channel == 0)
                continue; // nothing of it then or now
            const float factor = before.*channel > 0 ? std::min(now.*channel / before.*channel, kEndless) : kEndless;
            range.least.*channel = std::min(range.least.*channel, factor);
            range.most.*channel = std::max(range.most.*channel, factor);
        }
    }
    /// A light that is new bounds the factor below by the others'. Channels without light have none: any factor serves.
    LightRange result() const
    {
        LightRange r = range;
        for (const auto channel : kChannels)
            if (r.least.*channel > r.most.*channel)
                r.least.*channel = r.most.*channel = 1;
        return r;
    }
};

/// But for emission, and for how often it is picked.
bool sameLight(gpu::Light a, const gpu::Light& b)
{
    a.emission = b.emission;
    a.pmf = b.pmf;
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}
} // namespace

LightRange LightRange::anything()
{
    return {{}, {kEndless, kEndless, kEndless}};
}

gpu::vec3 LightRange::surely() const
{
    gpu::vec3 factor{};
    for (const auto channel : kChannels)
        factor.*channel = std::clamp(1.0f, least.*channel, most.*channel);
    return factor;
}

bool LightRange::operator==(const LightRange& other) const
{
    return std::ranges::all_of(
        kChannels,
        [&](auto channel) { return least.*channel == other.least.*channel && most.*channel == other.most.*channel; });
}

LightRange lightRange(const Emitters& before, const Emitters& now)
{
    check(before.lights.size() == now.lights.size() && before.emissions.size() == now.emissions.size(), "{} lights, {}",
          before.lights.size(), now.lights.size());
    Widened widened;
    for (size_t i = 0; i < now.lights.size(); ++i)
    {
        if (!sameLight(before.lights[i], now.lights[i]))
            return LightRange::anything();
        widened.add(before.lights[i].emission, now.lights[i].emission);
    }
    for (size_t i = 0; i < now.emissions.size(); ++i)
        widened.add(before.emissions[i], now.emissions[i]);
    return widened.result();
}
