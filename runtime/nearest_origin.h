// Which of several ways of making a picture it comes closest to.
#pragma once
#include "image/picture_origin.h"

#include <algorithm>

/// The shortest difference() to one of `wanted`, at least one; empty where there is none to one of them.
inline std::string nearestDifference(const PictureOrigin& is, std::span<const PictureOrigin> wanted)
{
    std::string nearest = difference(is, wanted.front());
    for (const PictureOrigin& one : wanted.subspan(1))
        nearest =
            std::min(nearest, difference(is, one), [](const auto& a, const auto& b) { return a.size() < b.size(); });
    return nearest;
}
