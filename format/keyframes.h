// The value of an animated property between its keys (glTF 2.0, 3.11 and appendix C).
#pragma once
#include "format/motion_generated.h"

#include <span>

namespace package
{
/// One property over time. What is verified or imported fits together: values are those of lumicut::fb::Channel.
struct Keyframes
{
    std::span<const float> times;  // seconds, strictly increasing, at least one
    std::span<const float> values; // key-major; CubicSpline: in-tangent, value, out-tangent of each key
    lumicut::fb::Interpolation interpolation = lumicut::fb::Interpolation::Linear;
    bool rotation = false; // unit quaternions x y z w: Linear goes the shorter way along the sphere
};

/// Before the first key the property has its value, after the last one likewise. Rotations come out normalised.
/// @param out as many numbers as the property has
void sampleKeyframes(const Keyframes& keys, double seconds, std::span<double> out);
} // namespace package
