#include "runtime/global_illumination.h"

#include <algorithm>
#include <cmath>

namespace
{
gpu::vec3 extentOf(const gpu::SceneInfo& info)
{
    return {info.bounds_max.x - info.bounds_min.x, info.bounds_max.y - info.bounds_min.y, info.bounds_max.z - info.bounds_min.z};
}

/// Progressive photon mapping: r_n^2 / r_0^2 = prod (i + 2/3) / (i + 1) over the frames before (Hachisuka et al. 2008;
/// Knaus & Zwicker 2011), so that noise and bias vanish together.
float shrunkRadius(float radius, uint32_t frame)
{
    constexpr double kAlpha = 2.0 / 3.0;
    const double n = frame + 1;
    return radius * float(std::sqrt(std::tgamma(1.0 + 1.0) / std::tgamma(1.0 + kAlpha) * std::exp(std::lgamma(n + kAlpha) - std::lgamma(n + 1.0))));
}
} // namespace

GlobalIllumination::GlobalIllumination(const Device& device, const SceneGpu& scene, const Settings& settings, uint32_t width,
                                       uint32_t height)
    : width_(width), height_(height), diagonal_(0), longest_side_(0), has_specular_(scene.hasFeature(gpu::kFeatureSpecular)),
      primary_(device, scene, width * height), direct_(device, scene, width * height),
      photons_(device, scene, PhotonKind::kGlobal, settings.photon_count, settings.photon_bounces),
      caustic_photons_(device, scene, PhotonKind::kCaustic, settings.caustic_photons, 2),
      photon_tree_(device, "photon_tree", settings.photon_count * settings.photon_bounces),
      caustic_tree_(device, "caustic_tree", settings.caustic_photons * 2),
      cut_(device, settings.photon_count * settings.photon_bounces), samples_(device, scene, width, height, settings.sample_count),
      gather_(device, scene, settings.sample_count, settings.gather_rays), interpolate_(device, scene, settings.sample_count),
      caustics_(device, scene)
{
    const gpu::vec3 extent = extentOf(scene.info());
    diagonal_ = std::sqrt(extent.x * extent.x + extent.y * extent.y + extent.z * extent.z);
    longest_side_ = std::max({extent.x, extent.y, extent.z, 1e-20f});
}

const Buffer& GlobalIllumination::record(Recorder& rec, const RayStage& rays, const gpu::CameraParams& camera, const Settings& settings)
{
    const uint32_t pixel_count = width_ * height_;
    const uint32_t frame = camera.first_sample;
    const uint32_t seed = traceSeed(camera.seed, frame, 0x9100u);
    const float alpha = settings.sample_alpha * 2 / longest_side_;
    const auto primary = primary_.record(rec, rays, {.camera = camera, .specular_depth = settings.specular_depth});
    const Buffer& points = primary.points;
    const Buffer& radiance = primary.radiance;
    direct_.record(rec, rays,
                   {.points = points,
                    .radiance = radiance,
                    .point_count = pixel_count,
                    .light_sample_count = settings.direct_samples,
                    .first_sample = frame,
                    .seed = camera.seed});

    const auto photons = [&]
    {
        const auto scope = rec.scope("photons");
        return photons_.record(rec, rays,
                               {.path_count = settings.photon_count,
                                .bounce_limit = settings.photon_bounces,
                                .specular_depth = settings.specular_depth,
                                .first_path = frame * settings.photon_count,
                                .seed = camera.seed});
    }();
    const auto map = [&]
    {
        const auto scope = rec.scope("photon tree");
        return photon_tree_.record(rec, rays, photons);
    }();
    const float density_radius = shrunkRadius(settings.density_radius * diagonal_, frame);
    const auto cut = [&]
    {
        const auto scope = rec.scope("cut");
        return cut_.record(rec, rays, map,
                           {.mode = CutMode(settings.cut_mode),
                            .iterations = settings.cut_iterations,
                            .difference = settings.cut_difference,
                            .photon_count = settings.density_photons,
                            .radius = density_radius});
    }();
    const auto samples = [&]
    {
        const auto scope = rec.scope("samples");
        return samples_.record(rec, rays,
                               {.shading_points = points,
                                .mode = SamplesMode(settings.samples_mode),
                                .budget = settings.sample_count,
                                .iterations = settings.sample_iterations,
                                .alpha = alpha,
                                .seed = seed});
    }();
    {
        const auto scope = rec.scope("gather");
        gather_.record(rec, rays, samples, map, cut,
                       {.mode = CutMode(settings.cut_mode),
                        .ray_count = settings.gather_rays,
                        .specular_depth = settings.specular_depth,
                        .photon_count = settings.density_photons,
                        .radius = density_radius,
                        .seed = seed});
    }
    {
        const auto scope = rec.scope("interpolate");
        interpolate_.record(rec, samples,
                            {.points = points,
                             .radiance = radiance,
                             .point_count = pixel_count,
                             .alpha = alpha,
                             .radius = settings.density_radius * diagonal_});
    }
    if (has_specular_)
    {
        const auto scope = rec.scope("caustics");
        const auto stored = caustic_photons_.record(rec, rays,
                                                    {.path_count = settings.caustic_photons,
                                                     .bounce_limit = 2,
                                                     .specular_depth = settings.specular_depth,
                                                     .first_path = frame * settings.caustic_photons,
                                                     .seed = camera.seed + 1});
        const auto caustic_map = caustic_tree_.record(rec, rays, stored);
        caustics_.record(rec, caustic_map,
                         {.points = points,
                          .radiance = radiance,
                          .point_count = pixel_count,
                          .photon_count = settings.caustic_density_photons,
                          .radius = shrunkRadius(settings.caustic_radius * diagonal_, frame)});
    }
    return radiance;
}
