// Lights that change from frame to frame of a measurement.
#pragma once
#include "tools/bench/opened.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// How lights change. A source is one light, or all triangles that emit alike; the first is the one with the most power.
enum class LightChange
{
    kSteady, // not at all
    kPulse,  // all of them together, once in 30 frames between half and twice their power
    kLamp,   // so does the first source alone
    kTint,   // the first source's colour, once in 30 frames between reddish and bluish, at equal luminance
    kOff,    // the first source goes off
    kOrbit,  // a light moves; see chooseMovingLight()
};

/// Names of LightChange on command lines, in its order.
inline constexpr std::array kLightChangeNames{"steady", "pulse", "lamp", "tint", "off", "orbit"};

/// The first directional light, else the first point or spot light, as movedLight() moves it; none where there is none.
std::optional<uint32_t> chooseMovingLight(std::span<const gpu::Light> lights);

class ChangingLights
{
public:
    /// @param opened borrowed
    /// @param off_frame of LightChange::kOff, the first frame without
    /// @return kInvalid where the package has no light that changes so
    static Result<ChangingLights> create(const OpenedPackage& opened, LightChange change, int32_t off_frame);

    /// Makes the lights those of a frame, from the next kernel of `rec` on. Frames before the first are negative.
    void set(Recorder& rec, int32_t frame);
    /// Makes them those of the package.
    void restore(Recorder& rec);
    /// XXH3-64 of what set() has replaced; 0: nothing.
    uint64_t hash() const { return hash_; }

private:
    ChangingLights(const OpenedPackage& opened, LightChange change, int32_t off_frame)
        : opened_(&opened), change_(change), off_frame_(off_frame)
    {
    }
    void scale(Recorder& rec, gpu::vec3 factor);

    const OpenedPackage* opened_;
    LightChange change_;
    int32_t off_frame_;
    std::vector<uint32_t> lights_, materials_; // that change
    uint64_t hash_ = 0;
};
