// Global illumination after Wang et al. 2009: photons, their tree, the illumination cut, irradiance samples, final
// gathering, interpolation, glossy reflection and caustics, all on the GPU.
#pragma once
#include "runtime/settings.h"
#include "runtime/stages/caustics.h"
#include "runtime/stages/direct.h"
#include "runtime/stages/gather.h"
#include "runtime/stages/glossy.h"
#include "runtime/stages/guide.h"
#include "runtime/stages/interpolate.h"
#include "runtime/stages/primary.h"
#include "runtime/stages/views.h"

#include <optional>

class GlobalIllumination
{
public:
    /// @return kDevice naming the settings whose product needs a larger buffer than `range` bytes
    static Status checkCounts(uint64_t range, const Settings& settings);

    /// Allocates for pictures of width x height pixels and for the counts in `settings`; later settings may ask for fewer
    /// photons, samples and rays, not for more.
    GlobalIllumination(const Device& device, const SceneGpu& scene, const Settings& settings, uint32_t width, uint32_t height);

    /// Records one frame: one sample a pixel, vec3[width * height]; of settings.term alone where that is not all, and
    /// the colours of settings.view where that is one, whatever the term.
    /// @param camera with first_sample: the frame's index in a standing picture
    const Buffer& record(Recorder& rec, const RayStage& rays, const gpu::CameraParams& camera, const Settings& settings);
    /// Of the last frame; waits for the device.
    std::vector<gpu::Sample> irradianceSamples(const Device& device) const { return samples_.download(device); }

private:
    struct Frame;
    uint32_t chainDepth(const Settings& settings) const;
    void recordDirect(const Frame& frame) const;
    PhotonStage::Output emitPhotons(const Frame& frame);
    PhotonTreeStage::Output recordPhotons(const Frame& frame);
    void rehearse(const Frame& frame);
    SamplesStage::Output recordSamples(const Frame& frame) const;
    GatherStage::Input gatherInput(const Frame& frame) const;
    CutStage::Output recordCut(const Frame& frame, const PhotonTreeStage::Output& map) const;
    bool reflectsByHarmonics(const Frame& frame) const;
    InterpolateStage::Sorted recordGather(const Frame& frame, const PhotonTreeStage::Output& map, const CutStage::Output& cut);
    void recordIndirect(const Frame& frame, const InterpolateStage::Sorted& samples) const;
    void recordGlossy(const Frame& frame, const CutStage::Output& cut, const InterpolateStage::Sorted* samples) const;
    void recordCaustics(const Frame& frame) const;
    void recordView(const Frame& frame) const;

    uint32_t width_, height_;
    float diagonal_, longest_side_; // of the scene, metres
    bool has_specular_, reflects_roughly_, has_caustic_targets_, has_mirrors_;
    PrimaryStage primary_;
    DirectStage direct_;
    std::optional<GuideStage> guide_; // where it helps
    PhotonStage photons_, caustic_photons_;
    PhotonTreeStage photon_tree_, caustic_tree_;
    CutStage cut_;
    SamplesStage samples_;
    GatherStage gather_;
    InterpolateStage interpolate_;
    GlossyStage glossy_;
    CausticsStage caustics_;
    ViewsStage views_;
};
