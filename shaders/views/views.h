// Debug views: what the stages of global illumination made of a frame, as colours. Shared by runtime/stages/views.cpp and
// shaders/views/*.comp.
#ifndef SHADERS_VIEWS_H
#define SHADERS_VIEWS_H
#include "shaders/cut/cut.h"
#include "shaders/lib/choice.h"
#include "shaders/resolve/resolve.h"
#include "shaders/samples/samples.h"

GPU_NAMESPACE_BEGIN

#define GPU_VIEWS(X) \
    X(kViewNone, 0u, "none")             /* the picture */ \
    X(kViewNormals, 1u, "normals")       /* of the shading points: (n + 1) / 2 */ \
    X(kViewPositions, 2u, "positions")   /* of the shading points in the scene's bounds */ \
    X(kViewSamples, 3u, "samples")       /* irradiance samples over the picture */ \
    X(kViewClusters, 4u, "clusters")     /* a colour for each cluster of k-means, and its sample */ \
    X(kViewBudget, 5u, "budget")         /* samples that the quadtree gave a place, against their mean */ \
    X(kViewPhotons, 6u, "photons")       /* photons over the picture */ \
    X(kViewTree, 7u, "tree")             /* a colour for each node of one level of the photon tree */ \
    X(kViewCut, 8u, "cut")               /* a colour for each node of the cut, where it is the nearest */ \
    X(kViewIrradiance, 9u, "irradiance") /* interpolated irradiance / pi: the indirect light of a white surface */ \
    X(kViewNonFinite, 10u, "nonfinite")  /* pixels that are NaN or infinite */ \
    X(kViewError, 11u, "error")          /* how far the picture is from a reference */
GPU_VIEWS(GPU_CHOICE_CONSTANT)

GPU_CONST uint kViewTreeNodes = 4096u; // nodes of the level that is shown: the one that the cut's threshold comes from
GPU_CONST uint kViewPhotonShare = 2u;  // one photon of the map for so many pixels is shown at most

struct ViewParams
{
    uint view;  // kView*
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
    uint level; // that is shown
    float mean; // samples of a whole node of that level, were they spread evenly
};
GPU_SIZE(QuadViewParams, 36);

struct PhotonViewParams
{
    CameraParams camera;
    uint most; // photons to show
};
GPU_SIZE(PhotonViewParams, 92);

// Relative errors from kLeastError, dark, to 1, yellow, in even steps of the logarithm.
GPU_CONST float kLeastError = 1e-3f;

struct ErrorViewParams
{
    uint width; // pixels
    uint height;
    uint reference_width;
    uint reference_height;
    float scale;  // of the summed samples: 1 / their count
    float floor_; // radiance below which errors are relative to it: black has no relative error
};
GPU_SIZE(ErrorViewParams, 24);

GPU_NAMESPACE_END
#endif
