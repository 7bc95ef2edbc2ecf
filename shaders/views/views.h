// Debug views: what the stages of global illumination made of a frame, as colours. Shared by runtime/stages/views.cpp and
// shaders/views/*.comp.
#ifndef SHADERS_VIEWS_H
#define SHADERS_VIEWS_H
#include "shaders/cut/cut.h"
#include "shaders/resolve/resolve.h"
#include "shaders/samples/samples.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kViewNone = 0u;       // the picture
GPU_CONST uint kViewNormals = 1u;    // of the shading points: (n + 1) / 2
GPU_CONST uint kViewPositions = 2u;  // of the shading points in the scene's bounds
GPU_CONST uint kViewSamples = 3u;    // irradiance samples over the picture
GPU_CONST uint kViewClusters = 4u;   // a colour for each cluster of k-means, and its sample
GPU_CONST uint kViewBudget = 5u;     // samples that the quadtree gave a place, against their mean
GPU_CONST uint kViewPhotons = 6u;    // photons over the picture
GPU_CONST uint kViewTree = 7u;       // a colour for each node of one level of the photon tree
GPU_CONST uint kViewCut = 8u;        // a colour for each node of the cut, where it is the nearest
GPU_CONST uint kViewIrradiance = 9u; // interpolated irradiance / pi: the indirect light of a white surface
GPU_CONST uint kViewNonFinite = 10u; // pixels that are NaN or infinite
GPU_CONST uint kViewError = 11u;     // how far the picture is from a reference

GPU_CONST uint kViewTreeNodes = 4096u; // nodes of the level that is shown: the one that the cut's threshold comes from
GPU_CONST uint kViewPhotonShare = 2u;  // one photon of the map for so many pixels is shown at most

struct ViewParams
{
    uint view; // kView*
    uint width; // pixels
    uint height;
    uint curve;     // kTonemap* of the picture behind a view
    float exposure; // factor
};
GPU_SIZE(ViewParams, 20);

struct QuadViewParams
{
    ViewParams view;
    uint stride; // pixels between points of the quadtree
    uint levels;
    uint level;  // that is shown
    float mean;  // samples of a whole node of that level, were they spread evenly
};
GPU_SIZE(QuadViewParams, 36);

struct PhotonViewParams
{
    CameraParams camera;
    uint most; // photons to show
};
GPU_SIZE(PhotonViewParams, 76);

// Relative errors from kLeastError, dark, to 1, yellow, in even steps of the logarithm.
GPU_CONST float kLeastError = 1e-3f;

struct ErrorViewParams
{
    uint width; // pixels
    uint height;
    uint reference_width;
    uint reference_height;
    float scale; // of the summed samples: 1 / their count
    float floor_; // radiance below which errors are relative to it: black has no relative error
};
GPU_SIZE(ErrorViewParams, 24);

GPU_NAMESPACE_END
#endif
