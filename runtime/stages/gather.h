// Final gathering: hundreds of rays from every irradiance sample, or a few from every pixel of a static view, read the
// illumination cut where they end.
#pragma once
#include "runtime/stages/cut.h"
#include "runtime/stages/guide.h"
#include "runtime/stages/legs.h"
#include "runtime/stages/samples.h"
#include "shaders/gather/gather.h"
#include "shaders/gather/harmonics.h"

#include <algorithm>

class GatherStage
{
public:
    /// @param rays_per_sample as many rays in all are also spent where pixels gather for themselves
    GatherStage(const Device& device, const SceneGpu& scene, uint32_t max_samples, uint32_t rays_per_sample,
                uint32_t max_rays_per_sample, const Scratch& scratch = {});

    struct Input
    {
        CutMode mode;
        uint32_t ray_count;      // of a sample, <= max_rays_per_sample
        uint32_t specular_depth; // most delta events of a ray
        uint32_t photon_count;   // k, in CutMode::kKnn
        float radius;            // of density estimation at most, in CutMode::kKnn: of the distance from the viewer
        uint32_t seed;
        const LegsStage* legs = nullptr; // path segments by which rays are aimed; null: rays are cosine-distributed
        bool by_direction = false;       // whether harmonics() is wanted; only in scenes with rough reflection
    };
    /// Traces the samples' rays to their first hits, and only splats these into `guide`.
    void traceFirstHits(Recorder& rec, const RayStage& rays, const SamplesStage::Output& samples, const Input& in,
                        GuideStage& guide) const;
    /// Sets irradiance and harmonic_mean_distance of samples.samples. @param guide if not null, the ends of
    /// rays are splatted into it
    void record(Recorder& rec, const RayStage& rays, const SamplesStage::Output& samples,
                const PhotonTreeStage::Output& map, const CutStage::Output& cut, const Input& in,
                GuideStage* guide = nullptr) const;

    struct PixelInput
    {
        const Buffer& points;   // gpu::ShadingPoint[point_count]
        const Buffer& radiance; // vec3[point_count], grows by the indirect diffuse light
        uint32_t point_count;
        uint32_t frame; // in a static view: its rays continue those of the frames before
        uint32_t seed;  // of the picture
    };
    /// Rays of every pixel that cost as much as those of the samples; at least one, which may cost more.
    uint32_t raysPerPixel(uint32_t pixel_count) const
    {
        return std::clamp(pixel_rays_ / pixel_count, 1u, kMostPixelRays);
    }
    /// Whether that is efficient: otherwise a picture needs many passes, as the ray buffers are small.
    bool suitsPixels(uint32_t pixel_count) const { return uint64_t(pixel_rays_) * kMostPasses >= pixel_count; }
    /// Indirect diffuse light without samples and interpolation: noise, and no blur but that of the cut.
    void recordPixels(Recorder& rec, const RayStage& rays, const PhotonTreeStage::Output& map,
                      const CutStage::Output& cut, const Input& in, const PixelInput& pixels,
                      GuideStage* guide = nullptr) const;

    /// The light of the samples by direction, as the last record() that was asked for it left it.
    const Buffer& harmonics() const { return harmonics_; } // gpu::SampleHarmonics[samples]

private:
    void traceFirstHits(Recorder& rec, const RayStage& rays, const SamplesStage::Output& samples,
                        const gpu::GatherParams& params, const LegsStage* legs, GuideStage* guide) const;

    static constexpr uint32_t kMostPixelRays = 256, kMostPasses = 8;

    gpu::GatherParams paramsOf(const Input& in) const;
    /// Sets gathered_ by the light that the rays of queue_ find, whose first hits are in hits_.
    void shade(Recorder& rec, const PhotonTreeStage::Output& map, const CutStage::Output& cut,
               const gpu::GatherParams& params) const;

    uint32_t max_samples_, pixel_rays_;
    bool has_specular_;
    Kernel generate_, generate_pixels_, shade_, shade_knn_, sum_, add_, project_;
    RayQueue queue_;
    Buffer hits_, states_, gathered_, directions_, no_legs_, harmonics_;
};
