// Global illumination after Wang et al. 2009: photons, their tree, the illumination cut, irradiance samples, final
// gathering, interpolation, glossy reflection and caustics, all on the GPU.
#pragma once
#include "runtime/frame/light_buffers.h"
#include "runtime/frame/plan.h"
#include "runtime/light_filter.h"
#include "runtime/stages/antialias.h"
#include "runtime/stages/caustics.h"
#include "runtime/stages/compose.h"
#include "runtime/stages/direct.h"
#include "runtime/stages/gather.h"
#include "runtime/stages/glossy.h"
#include "runtime/stages/guide.h"
#include "runtime/stages/interpolate.h"
#include "runtime/stages/layers.h"
#include "runtime/stages/primary.h"
#include "runtime/stages/view_scale.h"
#include "runtime/stages/views.h"

#include <optional>
#include <utility>

class GlobalIllumination
{
public:
    /// @return kDevice naming the settings whose product needs a larger buffer than `range` bytes
    static Status checkCounts(const VkPhysicalDeviceLimits& limits, uint64_t range, const Settings& settings);

    /// Allocates for pictures of width x height pixels and for the counts in `settings`; later settings may ask for
    /// fewer photons, samples and rays, not for more.
    GlobalIllumination(const Device& device, const SceneGpu& scene, const Settings& settings, uint32_t width,
                       uint32_t height);

    /// Records one frame: one sample a pixel, vec3[width * height]; of settings.term alone where that is not all, and
    /// the colours of settings.view where that is one, whatever the term.
    /// Photons, their trees and the cut are kept from one record() to the next where they would come out the same
    /// (reuse.photons).
    const Buffer& record(Recorder& rec, const RayStage& rays, const FrameInfo& frame, const Settings& settings);
    /// What the photon map of the last frame holds, nothing where it wanted none; waits for the device.
    gpu::PhotonStore photonStore(const Device& device) const
    {
        return global_map_ ? device.download<gpu::PhotonStore>(photons_.store(), 1)[0] : gpu::PhotonStore{};
    }
    /// gpu::Motion[width * height] of the last frame whose plan antialiases.
    const Buffer& motions() const { return filter_.motions(); }
    /// Of the last frame, where they move.
    std::optional<AntialiasStage::Highlights> highlights() const
    {
        return highlights_ ? std::optional<AntialiasStage::Highlights>({light_.direct, *highlights_}) : std::nullopt;
    }
    /// From now on record() keeps the layers of its pictures, but of views.
    void keepLayers(const Device& device) { layers_.emplace(device, scene_, width_ * height_); }
    /// gpu::LayerSums[width * height] over the frames of the picture so far.
    const Buffer& layerSums() const { return layers_->sums(); }
    /// Share of the pixels that went on from a history in the last frame, none where it kept none; waits for the device.
    std::optional<double> rememberedShare(const Device& device) const { return filter_.rememberedShare(device); }
    /// Of the last frame; waits for the device.
    std::vector<gpu::Sample> irradianceSamples(const Device& device) const { return samples_.download(device); }
    uint32_t cutNodeCount(const Device& device) const { return cut_.nodeCount(device); }
    /// From now on shading points and irradiance samples are those of that seed, whatever the frame's: so that what is
    /// gathered there can be compared.
    void placeSamplesBy(uint32_t seed) { placement_seed_ = seed; }

private:
    struct Context; // what the stages of one frame share
    FrameTraits traits() const;
    void recordDirect(const Context& c);
    PhotonStage::Input photonInput(const Context& c) const;
    bool needsViewScale(const Context& c) const;
    bool recordPhotons(const Context& c);
    void warmUp(const Context& c);
    bool isFar(const Context& c) const;
    PhotonTreeStage::Output recordMap(const Context& c, bool has_new_photons);
    CutStage::Output recordCut(const Context& c, const PhotonTreeStage::Output& map);
    SamplesStage::Input samplesInput(const Context& c) const;
    GatherStage::Input gatherInput(const Context& c) const;
    InterpolateStage::Sorted recordGather(const Context& c, const PhotonTreeStage::Output& map,
                                          const CutStage::Output& cut);
    void recordPixelGather(const Context& c, const PhotonTreeStage::Output& map, const CutStage::Output& cut);
    void recordIndirect(const Context& c, const InterpolateStage::Sorted& samples) const;
    void recordGlossy(const Context& c, const CutStage::Output& cut, const InterpolateStage::Sorted* samples) const;
    void recordCaustics(const Context& c);
    void recordView(const Context& c, const Buffer& picture) const;

    struct MapOrigin // what a photon map was made from
    {
        SceneVersion scene;
        PhotonStage::Input in;
        bool operator==(const MapOrigin&) const = default;
    };
    bool isThere(const Context& c, std::optional<MapOrigin>& made, const PhotonStage::Input& in) const;

    const SceneGpu& scene_;
    uint32_t width_, height_;
    bool has_specular_, has_caustic_targets_, has_mirrors_;
    uint32_t point_count_; // shading points: one a pixel, or two
    // Stages run one after the other, and share memory for what only they need; those of one Scratch hand some of it on.
    ScratchPool scratch_;
    ScratchPool caustic_pool_;              // caustics need not wait for what is recorded before them
    Scratch map_scratch_, caustic_scratch_; // of photons and their tree
    Scratch signals_scratch_;               // from the signals on to the end of the frame
    LightBuffers light_;
    std::optional<GuideStage> guide_; // where it helps
    PhotonStage photons_, caustic_photons_;
    PhotonTreeStage photon_tree_, caustic_tree_;
    PrimaryStage primary_; // beside photons, hence not in their memory
    ViewScaleStage view_scale_;
    DirectStage direct_; // likewise
    LegsStage legs_;
    CutStage cut_;
    SamplesStage samples_;
    GatherStage gather_;
    InterpolateStage interpolate_;
    GlossyStage glossy_;
    CausticsStage caustics_;
    std::pair<uint32_t, float> discs_;   // what the discs of the caustic map were made by: photons, radius
    const Buffer* highlights_ = nullptr; // of the last frame, of DirectStage
    LightFilter filter_;
    ComposeStage compose_;
    std::optional<LayersStage> layers_; // where they are asked for
    ViewsStage views_;
    gpu::vec3 map_camera_{};                            // where the camera was when the global map was made
    std::optional<MapOrigin> global_map_, caustic_map_; // that lie in the stages' buffers
    std::optional<CutStage::Input> made_cut_;           // over that global map
    std::optional<uint32_t> placement_seed_;            // of placeSamplesBy()
};
