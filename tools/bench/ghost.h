// What is left of the light after all lights have been switched off.
#pragma once
#include "tools/bench/motion.h"

#include <array>
#include <optional>

struct Ghost // fractions of the light of the last frame that was lit; nothing where it had none, or was not measured
{
    using Shares = std::array<std::optional<double>, 2>;
    static constexpr std::array<uint32_t, 2> kFrames{1, 4}; // after that one
    Shares all;                                             // all terms but emission, which is seen itself
    Shares indirect;                                        // the term "indirect" alone
};

/// The camera goes on along its path. Lights and emissions are as before afterwards.
Ghost measureGhost(const OpenedPackage& opened, const MotionBenchOptions& options, const CameraOfFrame& camera);
