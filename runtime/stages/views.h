// Debug views: the frame's radiance gives way to colours that show what the stages made of it.
#pragma once
#include "runtime/stages/cut.h"
#include "runtime/stages/samples.h"
#include "shaders/views/views.h"

/// Whether a view's colours are for the display as they are, without exposure and display transform.
inline bool isDisplayReferred(uint32_t view)
{
    return view != gpu::kViewNone && view != gpu::kViewIrradiance;
}
/// Whether a view shows a single frame: colours of indices cannot be averaged.
inline bool showsOneFrame(uint32_t view)
{
    return isDisplayReferred(view) && view != gpu::kViewNonFinite && view != gpu::kViewError;
}

class ViewsStage
{
public:
    ViewsStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels);

    struct Input
    {
        uint32_t view; // gpu::kView*
        gpu::CameraParams camera;
        const Buffer& points;   // gpu::ShadingPoint[width * height]
        const Buffer& radiance; // vec3[width * height]: the picture; becomes linear display-referred colours in [0,1]
        float exposure = 0;     // stops, of the picture that a view lies over
        uint32_t tonemap = gpu::kTonemapSrgb; // likewise
        uint32_t budget = 1;                  // samples that were asked for
    };
    /// One function for each source; `in.view` is one of those named.
    void recordPoints(Recorder& rec, const Input& in) const;    // kViewNormals, kViewPositions
    void recordNonFinite(Recorder& rec, const Input& in) const; // kViewNonFinite
    void recordSamples(Recorder& rec, const Input& in, const SamplesStage::Output& samples) const; // kViewSamples
    /// kViewClusters, kViewBudget.
    void recordQuadtree(Recorder& rec, const Input& in, const SamplesStage::Output& samples,
                        const SamplesStage::Quadtree& quadtree) const;
    void recordPhotons(Recorder& rec, const Input& in, const PhotonTreeStage::Output& map) const; // kViewPhotons
    void recordTree(Recorder& rec, const Input& in, const PhotonTreeStage::Output& map) const;    // kViewTree
    void recordCut(Recorder& rec, const Input& in, const CutStage::Output& cut) const;            // kViewCut

private:
    // Kernels are created when a view is first used, so that start-up does not pay for them.
    Kernel kernel(std::string_view name) const { return device_.kernel(name); }
    Kernel surfaceKernel(std::string_view name) const { return device_.kernel(name, scene_.constants()); }
    void markSamples(Recorder& rec, const gpu::ViewParams& params, const SamplesStage::Output& samples) const;

    const Device& device_;
    const SceneGpu& scene_;
    Buffer marks_;
};
