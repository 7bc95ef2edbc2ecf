// Photon guiding: learns from which cells of the lights photons fall where gathering rays end, and emits the next ones there.
// After projection maps (Jensen 2001, 5.3), learned rather than rasterized; every photon's power is divided by the change of
// its probability, so that the map stays unbiased whatever was learned.
#pragma once
#include "runtime/stages/rays.h"
#include "runtime/stages/stored_photons.h"
#include "shaders/guide/guide.h"

class GuideStage
{
public:
    /// Whether guiding is useful: with a directional or environment light, or many lights.
    static bool helps(const SceneGpu& scene);

    GuideStage(const Device& device, const SceneGpu& scene, uint32_t max_paths);

    /// Brings the distribution to the probabilities by which lights are picked now; what was learned stays. Records nothing where
    /// they are those of the last call.
    void followLights(Recorder& rec);
    /// Forgets everything; the lights' own distributions are used until learn().
    void reset(Recorder& rec);
    bool hasLearned() const { return has_learned_; }

    // What was learned last, for tests and views.
    const Buffer& cells() const { return cells_; } // uint[path_count]: where each path left; kNone: it did not
    const Buffer& distribution() const { return distribution_; } // gpu::GuideDistribution
    const Buffer& importance() const { return importance_; }     // uint[kGuideBins]: gathering rays that ended there

    /// `params.path_count` photons leave the lights by what was learned. @param starts gpu::PhotonStart[path_count]
    void emit(Recorder& rec, const Buffer& starts, const gpu::EmitParams& params) const;

    /// Splats the ends of these rays into the importance map, which is cleared before.
    /// @param hits gpu::Hit[queue capacity]
    /// @param more whether the splats of the last call are kept
    void splat(Recorder& rec, const RayQueue& queue, uint32_t max_rays, const Buffer& hits, bool more = false);
    /// Learns from the photons of the last emit().
    void learn(Recorder& rec, const StoredPhotons& map);

private:
    void runLearn(Recorder& rec, float memory) const;

    const SceneGpu& scene_;
    uint64_t table_version_;
    bool has_learned_ = false;
    Kernel emit_, splat_, value_, estimate_, fade_, learn_;
    Buffer groups_, other_lights_, distribution_, cells_, importance_, values_, largest_, estimates_, roots_;
    uint32_t max_paths_;
};
