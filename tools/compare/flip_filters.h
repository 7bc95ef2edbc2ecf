// The one-dimensional halves of FLIP's separable filters.
#pragma once
#include <vector>

/// Taps -radius..radius of a one-dimensional filter, applied as a correlation.
struct Taps
{
    std::vector<float> weights; // [2 * radius + 1]
    int radius() const { return int(weights.size() / 2); }
};

/// The eye's contrast sensitivity per opponent channel. Blue-yellow is the sum of two separable Gaussians: filter with
/// each in both directions, then add.
struct ContrastFilters
{
    Taps achromatic, red_green, blue_yellow[2];
};
ContrastFilters contrastFilters(float pixels_per_degree);

/// A Gaussian and its first and second derivatives. Positive and negative weights of a derivative sum to 1 and -1 each.
struct FeatureFilters
{
    Taps smooth, edge, point;
};
FeatureFilters featureFilters(float pixels_per_degree);
