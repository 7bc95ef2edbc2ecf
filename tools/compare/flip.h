// FLIP: how strongly a viewer sees the difference when two pictures are alternated on a screen.
// Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020, and "Visualizing Errors in
// Rendered High Dynamic Range Images", Eurographics 2021; constants and order of operations follow the authors'
// release 1.6.
#pragma once
#include "image/image.h"

/// 0.7 m in front of a screen 0.7 m and 3840 pixels wide: 67.02.
inline constexpr float kPixelsPerDegree = 67.0206433f;

struct FlipMap
{
    std::vector<float> error; // [width * height], each in 0..1
    double mean = 0;
};

/// The exposures (base-2 logarithms) between which HDR-FLIP looks for the largest error.
struct FlipExposures
{
    float start = 0;
    float stop = 0;
    uint32_t count = 2; // evenly spaced, both ends included
};

/// LDR-FLIP of two images in linear light; values outside 0..1 are clamped. Both must have the same size, at least 1
/// x 1.
FlipMap ldrFlip(const ImageF& reference, const ImageF& test, float pixels_per_degree = kPixelsPerDegree);

/// Exposures under which the ACES curve takes the brightest (start) and the median (stop) pixel of `reference` to 0.85.
/// Where the median is black, which release 1.6 cannot handle, the median of the pixels that are not black stands in.
FlipExposures flipExposures(const ImageF& reference);

/// HDR-FLIP: per pixel the largest LDR-FLIP error over `exposures` under the ACES curve. Negative radiance counts as 0.
FlipMap hdrFlip(const ImageF& reference, const ImageF& test, const FlipExposures& exposures,
                float pixels_per_degree = kPixelsPerDegree);
