// The frame: which stages run, in which order, and what they hand to each other.
#pragma once
#include "runtime/camera.h"
#include "runtime/filtered_paths.h"
#include "runtime/global_illumination.h"
#include "runtime/settings.h"
#include "runtime/stages/antialias.h"
#include "runtime/stages/direct.h"
#include "runtime/stages/error_view.h"
#include "runtime/stages/primary.h"
#include "runtime/stages/rays.h"
#include "runtime/stages/reference.h"
#include "runtime/stages/resolve.h"

#include <optional>

enum class Mode
{
    kDirect,        // emission, direct light, mirrors and glass
    kReference,     // everything, by path tracing
    kGi,            // everything, by photons and irradiance samples
    kFilteredPaths, // everything, by path tracing with the histories, filter and anti-aliasing of kGi: to compare with
};

class Renderer
{
public:
    /// @return kDevice where a picture of that size, or in Mode::kGi the counts in `settings`, need larger buffers than the
    /// device has
    static Status checkSize(const Device& device, uint32_t width, uint32_t height, Mode mode = Mode::kReference,
                            const Settings& settings = {});

    /// Allocates for pictures of `width` x `height` pixels; make another Renderer for another size,
    /// which checkSize() has let pass.
    /// Mode::kGi allocates for the counts in `settings`; record() may then be given smaller ones.
    Renderer(const Device& device, const SceneGpu& scene, Mode mode, uint32_t width, uint32_t height,
             const Settings& settings = {});

    /// Records one frame, `sample_count` more samples a pixel. A changed camera or light starts the picture anew.
    void record(Recorder& rec, const Camera& camera, const Settings& settings, uint32_t seed,
                uint32_t sample_count = 1);
    /// For an editor: from the next record() on lights are these, where they are, what they emit and how often they are picked; one
    /// that emits nothing is as if it were not there. That record() starts the picture anew, and histories go on as far as the
    /// change lets them. Lights keep their kinds. Of a lamp that is a surface, SceneGpu::setEmission() changes what is seen of it.
    /// @param scene the renderer's own, @param changed each of another light, by index as in SceneGpu::lights()
    void changeLights(Recorder& rec, SceneGpu& scene, std::span<const ChangedLight> changed);
    /// The next record() starts the picture anew: settings that decide what samples show have changed.
    void restart() { last_camera_.reset(); }
    /// What the view "error" compares the picture with; without it that view is the picture. See ErrorView.
    void compareWith(const Device& device, std::span<const gpu::vec3> reference, uint32_t width, uint32_t height);
    /// The picture so far as 8-bit sRGB pixels, uint[width * height].
    const Buffer& display(Recorder& rec, const Settings& settings, bool bgra);

    /// Small pictures leave a GPU idle: samples a pixel that fill it side by side in mode reference. A CPU gains nothing by that.
    static uint32_t batchFor(const Device& device, uint32_t pixel_count);
    /// Samples a pixel that one record() may take side by side.
    uint32_t maxBatch() const { return max_batch_; }
    uint32_t sampleCount() const { return resolve_.sampleCount(); }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    /// Mean linear radiance, or the colours of the view, vec3[width * height] rows from the top; waits for the device.
    std::vector<gpu::vec3> picture(const Device& device) const;
    /// In Mode::kGi: frames recorded from now on keep their layers.
    void keepLayers(const Device& device) { gi_->keepLayers(device); }
    /// Sums over sampleCount() frames, [width * height]; waits for the device. keepLayers() came before.
    std::vector<gpu::LayerSums> layerSums(const Device& device) const
    {
        return device.download<gpu::LayerSums>(gi_->layerSums(), uint64_t(width_) * height_);
    }
    /// Samples left out because they were NaN or infinite.
    uint32_t nonFiniteCount(const Device& device) const;
    /// What the photon map of the last frame in Mode::kGi holds; waits for the device.
    std::optional<gpu::PhotonStore> photonStore(const Device& device) const
    {
        return gi_ ? std::optional(gi_->photonStore(device)) : std::nullopt;
    }
    /// The irradiance samples of the last frame in Mode::kGi; waits for the device.
    std::vector<gpu::Sample> irradianceSamples(const Device& device) const { return gi_->irradianceSamples(device); }
    /// Nodes of the last frame's illumination cut in Mode::kGi, but for cut.mode knn; waits for the device.
    uint32_t cutNodeCount(const Device& device) const { return gi_->cutNodeCount(device); }
    /// Share of the pixels that went on from a history in the last frame; none where there are no histories.
    std::optional<double> rememberedShare(const Device& device) const
    {
        return gi_ ? gi_->rememberedShare(device) : paths_ ? paths_->rememberedShare(device) : std::nullopt;
    }
    /// In Mode::kGi: from now on shading points and irradiance samples are those of that seed, whatever the frame's.
    void placeSamplesBy(uint32_t seed) { gi_->placeSamplesBy(seed); }
    /// Counts the rays of frames recorded from now on; null ends that.
    void countRays(RayTally* tally) { rays_.countInto(tally); }

private:
    FrameInfo beginFrame(Recorder& rec, const Camera& camera, const Settings& settings, uint32_t seed);
    void recordDirect(Recorder& rec, const FrameInfo& frame, const Settings& settings);
    bool remembers() const
    {
        return gi_.has_value() || paths_.has_value();
    } // modes whose frames may go on from the last one
    void recordRemembering(Recorder& rec, const FrameInfo& frame, const Settings& settings);

    const SceneGpu& scene_;
    uint32_t width_, height_, max_batch_;
    RayStage rays_;
    std::optional<PrimaryStage> primary_;
    std::optional<DirectStage> direct_;
    Buffer direct_light_; // vec3[pixels], of Mode::kDirect
    std::optional<ReferenceStage> reference_;
    std::optional<GlobalIllumination> gi_;
    std::optional<FilteredPaths> paths_;
    std::optional<AntialiasStage> antialias_; // where frames remember, and it is asked for
    bool is_antialiased_ = false;             // the last frame
    ResolveStage resolve_;
    std::optional<ErrorView> error_;
    bool shows_error_ = false;                     // in the last frame
    std::optional<gpu::CameraParams> last_camera_; // none: the next picture starts anew
    SceneVersion last_scene_;
    Emitters last_emitters_; // where frames remember
    uint32_t frame_count_ = 0;
    uint32_t picture_seed_ = 0; // of all frames of a static view
    bool went_on_ = false;      // the last frame left histories
};
