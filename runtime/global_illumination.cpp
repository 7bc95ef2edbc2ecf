#include "runtime/global_illumination.h"

#include "runtime/camera.h"
#include "shaders/lib/terms.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace
{
constexpr uint32_t kCausticBounces = 2; // photons that a caustic path is given room for: one, and another behind a smooth layer

/// Of a wall that 12 rays to the rim may miss, a node's light passes 0.05 % at most.
constexpr uint32_t kRimProbes = 12;

/// Emissions before the first frame that the guide learns from. Through a window one photon in a hundred finds its way at first;
/// from one round to the next more do. The mean of a first frame of a room on a plain of 10 km varied by 16 % after one, by 9 %
/// after four and after eight (preset preview); with the default preset, and in Sponza, eight are noisier than four: a guide that
/// is sure of itself sends little elsewhere.
constexpr uint32_t kRehearsals = 4;

constexpr float kGuideReach = 0.25f; // of the view distance: how far from their camera guided photons serve

/// What reflects this much sends a glossy ray from every pixel: a standing picture can wait for less noise.
constexpr float kSureInMotion = 0.2f, kSureStanding = 0.05f;

/// A standing picture interpolates until every pixel could have had this many rays of its own (kLeastInterpolated frames at
/// least), then takes those: the blur of the first frames fades, and their lack of noise covers the noise of the next ones.
constexpr uint32_t kOwnRays = 256, kLeastInterpolated = 8;

/// Progressive photon mapping: r_n^2 / r_0^2 = prod (i + 2/3) / (i + 1) over the n frames before (Hachisuka et al.
/// 2008; Knaus & Zwicker 2011), so that noise and bias vanish together.
float shrunkRadius(float radius, uint32_t frame)
{
    constexpr double kAlpha = 2.0 / 3.0;
    const double log_ratio = std::lgamma(frame + 1 + kAlpha) - std::lgamma(frame + 2.0) - std::lgamma(1 + kAlpha);
    return radius * float(std::exp(0.5 * log_ratio));
}

/// Photons that a map of `wanted` has room for: no more than this device's buffers hold of what is made of each.
uint32_t photonCapacity(const Device& device, uint64_t wanted)
{
    const uint64_t range =
        std::min<uint64_t>(device.limits().maxStorageBufferRange, device.limits().maxTexelBufferElements * kTexelBytes);
    return uint32_t(std::min(wanted, range / std::max(2 * sizeof(gpu::CutNode), sizeof(gpu::PhotonSums))));
}
} // namespace

struct GlobalIllumination::Frame
{
    Recorder& rec;
    const RayStage& rays;
    const gpu::CameraParams& camera;
    const Settings& settings;
    const Buffer& points;         // gpu::ShadingPoint[pixel_count]
    const Buffer& diffuse_points; // gpu::DiffusePoint[pixel_count]
    const Buffer& radiance;       // vec3[pixel_count]
    uint32_t pixel_count;
    uint32_t index; // in a standing picture
    uint32_t seed;  // of this frame alone
    uint32_t placement_seed; // the same, of where irradiance samples are
    bool moved;     // the camera, since the last frame
    bool shows(uint32_t term) const
    {
        if (settings.view != gpu::kViewNone)
            return settings.view != gpu::kViewIrradiance || term == gpu::kTermIndirect;
        return settings.term == gpu::kTermAll || settings.term == term;
    }
};

Status GlobalIllumination::checkCounts(const VkPhysicalDeviceLimits& limits, uint64_t range, const Settings& settings)
{
    const auto tooLarge = [&](const char* names, uint64_t most) -> Status
    {
        return Error{ExitCode::kDevice,
                     fmt::format("{} is more than this device's buffers hold, {}; lower one of them", names, most)};
    };
    const uint64_t threads = uint64_t(limits.maxComputeWorkGroupCount[0]) * gpu::kRaysGroupSize;
    const uint64_t most_rays = std::min(range / sizeof(gpu::Ray), threads), most_starts = range / sizeof(gpu::PhotonStart);
    if (settings.photon_count > most_starts)
        return tooLarge("photons.count", most_starts);
    if (settings.caustic_photons > most_starts)
        return tooLarge("caustics.photons", most_starts);
    if (uint64_t(settings.sample_count) * settings.gather_rays > most_rays)
        return tooLarge("samples.count x gather.rays", most_rays);
    return Success{};
}

GlobalIllumination::GlobalIllumination(const Device& device, const SceneGpu& scene, const Settings& settings,
                                       uint32_t width, uint32_t height)
    : scene_(scene), width_(width), height_(height),
      has_specular_(scene.hasFeature(gpu::kFeatureSpecular)), reflects_roughly_(scene.reflectsRoughly()),
      has_caustic_targets_(scene.info().caustic_target_count > 0),
      has_mirrors_(has_caustic_targets_ || scene.hasFeature(gpu::kFeatureTransmission | gpu::kFeatureThin)),
      primary_(device, scene, width * height), view_scale_(device, scene), direct_(device, scene, width * height),
      photons_(device, scene, PhotonKind::kGlobal, settings.photon_count, photonCapacity(device, settings.photon_capacity)),
      caustic_photons_(device, scene, PhotonKind::kCaustic, settings.caustic_photons,
                       photonCapacity(device, uint64_t(settings.caustic_photons) * kCausticBounces)),
      photon_tree_(device, "photon_tree", photonCapacity(device, settings.photon_capacity)),
      caustic_tree_(device, "caustic_tree",
                    photonCapacity(device, uint64_t(settings.caustic_photons) * kCausticBounces)),
      legs_(device), cut_(device, scene, photonCapacity(device, settings.photon_capacity)),
      samples_(device, width, height, settings.sample_count),
      gather_(device, scene, settings.sample_count, settings.gather_rays), interpolate_(device, settings.sample_count),
      glossy_(device, scene, width * height), caustics_(device, scene), views_(device, scene, width * height)
{
    if (GuideStage::helps(scene))
        guide_.emplace(device, scene, settings.photon_count);
    if (settings.denoise_passes > 0 && (direct_.isNoisy() || has_specular_))
        denoise_.emplace(device, scene, width * height);
}

const Buffer& GlobalIllumination::record(Recorder& rec, const RayStage& rays, const gpu::CameraParams& camera,
                                         const Settings& settings, bool moved)
{
    gpu::CameraParams placement = camera;
    placement.seed = placement_seed_.value_or(camera.seed);
    const auto primary = primary_.record(rec, rays, {.camera = placement, .specular_depth = settings.specular_depth});
    view_scale_.record(rec, primary.points, width_ * height_, camera);
    const Frame frame{.rec = rec,
                      .rays = rays,
                      .camera = camera,
                      .settings = settings,
                      .points = primary.points,
                      .diffuse_points = primary.diffuse_points,
                      .radiance = primary.radiance,
                      .pixel_count = width_ * height_,
                      .index = camera.first_sample,
                      .seed = traceSeed(camera.seed, camera.first_sample, gpu::kTermIndirect),
                      .placement_seed = traceSeed(placement.seed, camera.first_sample, gpu::kTermIndirect),
                      .moved = moved};
    if (!frame.shows(gpu::kTermEmission))
        rec.clear(frame.radiance);
    if (frame.shows(gpu::kTermDirect))
        recordDirect(frame);
    const bool glossy = has_specular_ && frame.shows(gpu::kTermGlossy);
    if (frame.shows(gpu::kTermIndirect) || glossy)
    {
        const PhotonTreeStage::Output map = recordPhotons(frame);
        const CutStage::Output cut = recordCut(frame, map);
        std::optional<InterpolateStage::Sorted> samples;
        const bool looks = frame.shows(gpu::kTermIndirect) || guide_; // the guide learns the same whatever is shown
        if (looks && gathersAtPixels(frame))
            recordPixelGather(frame, map, cut);
        else if (looks || reflectsByHarmonics(frame))
            samples.emplace(recordGather(frame, map, cut));
        if (!frame.shows(gpu::kTermIndirect))
            rec.clear(frame.radiance); // of what pixels have gathered; a picture of glossy light alone holds nothing else yet
        if (samples && frame.shows(gpu::kTermIndirect))
            recordIndirect(frame, *samples);
        if (glossy)
            recordGlossy(frame, cut, samples ? &*samples : nullptr);
    }
    if (has_specular_ && frame.shows(gpu::kTermCaustics))
        recordCaustics(frame);
    if (settings.view != gpu::kViewNone)
        recordView(frame);
    return frame.radiance;
}

/// Delta events that gathering rays follow: each costs rays a pass over a mostly empty queue. Without mirrors
/// and glass there are only smooth layers over something diffuse, whose third reflections are too faint to matter.
uint32_t GlobalIllumination::chainDepth(const Settings& settings) const
{
    return has_mirrors_ ? settings.specular_depth : std::min(settings.specular_depth, 2u);
}

/// A standing picture needs the filter less with every frame: for four times the samples one pass less, until none is left
/// and the picture is on its way to what it should be.
uint32_t GlobalIllumination::denoisePasses(const Frame& frame) const
{
    const uint32_t fewer = uint32_t(std::bit_width(frame.index + 1)) / 2;
    return denoise_ && frame.settings.view == gpu::kViewNone && frame.settings.denoise_passes > fewer
               ? frame.settings.denoise_passes - fewer
               : 0;
}

const Buffer& GlobalIllumination::noisyLight(const Frame& frame) const
{
    if (denoisePasses(frame) == 0)
        return frame.radiance;
    denoise_->clear(frame.rec);
    return denoise_->light();
}

/// @param glossy whether the light is that of specular lobes alone
void GlobalIllumination::recordDenoise(const Frame& frame, bool glossy) const
{
    if (const uint32_t passes = denoisePasses(frame))
        denoise_->record(frame.rec, {.points = frame.points,
                                     .radiance = frame.radiance,
                                     .width = width_,
                                     .height = height_,
                                     .passes = passes,
                                     .pixel_angle = frame.camera.orthographic ? 0 : pixelSide(frame.camera),
                                     .glossy = glossy,
                                     .shares = glossy_.shares(),
                                     .shared = glossy && reflectsByHarmonics(frame)});
}

void GlobalIllumination::recordDirect(const Frame& frame) const
{
    direct_.record(frame.rec, frame.rays,
                   {.points = frame.points,
                    .radiance = frame.radiance,
                    .noisy = direct_.isNoisy() ? noisyLight(frame) : frame.radiance,
                    .point_count = frame.pixel_count,
                    .light_sample_count = frame.settings.direct_samples,
                    .candidate_count = frame.settings.direct_candidates,
                    .first_sample = frame.index,
                    .seed = frame.camera.seed});
    if (direct_.isNoisy())
        recordDenoise(frame, false);
}

PhotonStage::Input GlobalIllumination::photonInput(const Frame& frame) const
{
    return {.path_count = frame.settings.photon_count,
            .first_path = frame.index * frame.settings.photon_count,
            .seed = frame.camera.seed,
            .guide = guide_ ? &*guide_ : nullptr};
}

PhotonStage::Output GlobalIllumination::emitPhotons(const Frame& frame)
{
    const PhotonStage::Output stored = photons_.record(frame.rec, frame.rays, photonInput(frame));
    if (guide_)
        guide_->learn(frame.rec, stored);
    return stored;
}

/// Before the first frame the guide knows nothing: looks where light will be wanted, and follows photons to learn which of
/// them get there.
void GlobalIllumination::rehearse(const Frame& frame)
{
    guide_->reset(frame.rec);
    gather_.look(frame.rec, frame.rays, samples_.record(frame.rec, frame.rays, samplesInput(frame, 0)),
                 gatherInput(frame), *guide_);
    for (uint32_t round = 0; round < kRehearsals; ++round)
    {
        PhotonStage::Input in = photonInput(frame);
        in.seed = traceSeed(in.seed, round, gpu::kTermIndirect); // what is learned from the photons that are used is biased
        guide_->learn(frame.rec, photons_.record(frame.rec, frame.rays, in));
    }
}

/// Whether the map that `made` tells of is the one that `in` would give; else notes that it is about to be made. A
/// standing picture asks for other photons in every frame.
bool GlobalIllumination::isThere(const Frame& frame, std::optional<MapOrigin>& made, const PhotonStage::Input& in) const
{
    const MapOrigin asked{.lights = scene_.lightsVersion(), .in = in};
    if (frame.settings.reuse_photons && made == asked)
        return true;
    made = asked;
    return false;
}

/// Guided photons are where the camera that they were made for wants light: far from there others are due.
bool GlobalIllumination::isFar(const Frame& frame) const
{
    const gpu::vec3 a = frame.camera.position, b = map_camera_;
    return guide_ && std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) > kGuideReach * view_scale_.lastDistance();
}

PhotonTreeStage::Output GlobalIllumination::recordPhotons(const Frame& frame)
{
    if (isFar(frame))
        global_map_.reset();
    if (isThere(frame, global_map_, photonInput(frame)))
        return photon_tree_.output();
    made_cut_.reset();
    map_camera_ = frame.camera.position;
    const PhotonStage::Output stored = [&]
    {
        const auto scope = frame.rec.scope("photons");
        if (guide_ && !guide_->hasLearned())
            rehearse(frame);
        return emitPhotons(frame);
    }();
    legs_.record(frame.rec, stored, frame.seed);
    const auto scope = frame.rec.scope("photon tree");
    return photon_tree_.record(frame.rec, stored);
}

CutStage::Output GlobalIllumination::recordCut(const Frame& frame, const PhotonTreeStage::Output& map)
{
    const Settings& settings = frame.settings;
    const auto scope = frame.rec.scope("cut");
    const float shrink = shrunkRadius(1, frame.index);
    const CutStage::Input in{.mode = CutMode(settings.cut_mode),
                             .iterations = settings.cut_iterations,
                             .difference = settings.cut_difference,
                             .photon_count = settings.density_photons,
                             .radius = shrunkRadius(settings.density_radius, frame.index),
                             .shrink = shrink,
                             .fewest = std::max(uint32_t(gpu::kCutFewest * shrink * shrink), 1u),
                             .probes = settings.cut_probes,
                             .rim_probes = kRimProbes,
                             .seed = frame.seed};
    if (made_cut_ == in)
        return cut_.output();
    made_cut_ = in;
    return cut_.record(frame.rec, frame.rays, map, in);
}

/// Samples are kept from the first frame of one picture to that of the next where nothing but the camera has changed. A
/// standing picture takes new ones in every frame.
uint32_t GlobalIllumination::sampleAge(const Frame& frame)
{
    const SamplesOrigin now{.lights = scene_.lightsVersion(), .seed = frame.camera.seed, .settings = frame.settings};
    const bool keeps = frame.settings.reuse_samples && frame.moved && frame.index == 0 && last_samples_ == now;
    last_samples_ = frame.index == 0 ? std::optional(now) : std::nullopt;
    sample_age_ = keeps ? sample_age_ + 1 : 0;
    return sample_age_;
}

/// @param age frames since all samples were new
SamplesStage::Input GlobalIllumination::samplesInput(const Frame& frame, uint32_t age) const
{
    const Settings& settings = frame.settings;
    return {.diffuse_points = frame.diffuse_points,
            .mode = SamplesMode(settings.samples_mode),
            .budget = settings.sample_count,
            .iterations = settings.sample_iterations,
            .alpha = settings.sample_alpha,
            .reach = settings.sample_reach,
            .seed = frame.placement_seed,
            .age = age};
}

GatherStage::Input GlobalIllumination::gatherInput(const Frame& frame) const
{
    const Settings& settings = frame.settings;
    SamplesStage::Input placed = samplesInput(frame, sample_age_);
    placed.seed = frame.seed;
    return {.mode = CutMode(settings.cut_mode),
            .ray_count = settings.gather_rays,
            .specular_depth = chainDepth(settings),
            .photon_count = settings.density_photons,
            .radius = settings.density_radius,
            .seed = placed.frameSeed(),
            .legs = &legs_,
            .by_direction = reflectsByHarmonics(frame)};
}

InterpolateStage::Sorted GlobalIllumination::recordGather(const Frame& frame, const PhotonTreeStage::Output& map,
                                                          const CutStage::Output& cut)
{
    const SamplesStage::Output samples = [&]
    {
        const auto scope = frame.rec.scope("samples");
        return samples_.record(frame.rec, frame.rays, samplesInput(frame, sampleAge(frame)));
    }();
    {
        const auto scope = frame.rec.scope("gather");
        gather_.record(frame.rec, frame.rays, samples, map, cut, gatherInput(frame), guide_ ? &*guide_ : nullptr);
    }
    const auto scope = frame.rec.scope("interpolate");
    return interpolate_.sort(frame.rec, samples);
}

void GlobalIllumination::recordIndirect(const Frame& frame, const InterpolateStage::Sorted& samples) const
{
    const auto scope = frame.rec.scope("interpolate");
    interpolate_.record(frame.rec, samples,
                        {.diffuse_points = frame.diffuse_points,
                         .radiance = frame.radiance,
                         .point_count = frame.pixel_count,
                         .width = width_,
                         .alpha = frame.settings.sample_alpha,
                         .white = frame.settings.view == gpu::kViewIrradiance});
}

/// Interpolation blurs what is smaller than the distance of samples, however many frames it has.
bool GlobalIllumination::gathersAtPixels(const Frame& frame) const
{
    const uint32_t rays = gather_.raysPerPixel(frame.pixel_count);
    return frame.settings.view != gpu::kViewIrradiance && gather_.suitsPixels(frame.pixel_count) &&
           frame.index >= std::max(kOwnRays / rays, kLeastInterpolated);
}

void GlobalIllumination::recordPixelGather(const Frame& frame, const PhotonTreeStage::Output& map,
                                           const CutStage::Output& cut)
{
    const auto scope = frame.rec.scope("gather");
    gather_.recordPixels(frame.rec, frame.rays, map, cut, gatherInput(frame),
                         {.points = frame.points,
                          .radiance = frame.radiance,
                          .point_count = frame.pixel_count,
                          .frame = frame.index,
                          .seed = traceSeed(frame.camera.seed, 0, gpu::kTermIndirect)},
                         guide_ ? &*guide_ : nullptr);
}

/// Rough reflection is from the samples' harmonics in the first frame of a picture, with little noise; harmonics of
/// order 4 cannot tell everything, so that the frames after it send rays.
bool GlobalIllumination::reflectsByHarmonics(const Frame& frame) const
{
    return reflects_roughly_ && GlossyMode(frame.settings.glossy_mode) == GlossyMode::kHarmonics && frame.index == 0 &&
           frame.shows(gpu::kTermGlossy);
}

void GlobalIllumination::recordGlossy(const Frame& frame, const CutStage::Output& cut,
                                      const InterpolateStage::Sorted* samples) const
{
    const GlossyStage::Input in{.points = frame.points,
                                .radiance = frame.radiance,
                                .noisy = noisyLight(frame),
                                .point_count = frame.pixel_count,
                                .width = width_,
                                .first_sample = frame.index,
                                .specular_depth = chainDepth(frame.settings),
                                .seed = frame.camera.seed,
                                .sure_reflectance = frame.index == 0 ? kSureInMotion : kSureStanding,
                                .shared = reflectsByHarmonics(frame)};
    {
        const auto scope = frame.rec.scope("glossy");
        if (in.shared)
            glossy_.recordHarmonics(frame.rec, *samples, gather_.harmonics(), in);
        glossy_.record(frame.rec, frame.rays, cut, in);
    }
    recordDenoise(frame, true);
}

void GlobalIllumination::recordCaustics(const Frame& frame)
{
    const Settings& settings = frame.settings;
    const auto scope = frame.rec.scope("caustics");
    // Without mirrors and glass to aim at there are only the faint reflections of smooth layers: few photons will do.
    const uint32_t path_count = has_caustic_targets_ ? settings.caustic_photons : settings.caustic_photons / 8;
    const PhotonStage::Input in{.path_count = path_count,
                                .first_path = frame.index * path_count,
                                .seed = frame.camera.seed + gpu::kTermCaustics};
    if (!isThere(frame, caustic_map_, in))
        caustic_tree_.record(frame.rec, caustic_photons_.record(frame.rec, frame.rays, in));
    caustics_.record(frame.rec, caustic_tree_.output(),
                     {.points = frame.points,
                      .radiance = frame.radiance,
                      .point_count = frame.pixel_count,
                      .photon_count = settings.caustic_density_photons,
                      .radius = shrunkRadius(settings.caustic_radius, frame.index)});
}

void GlobalIllumination::recordView(const Frame& frame) const
{
    const auto scope = frame.rec.scope("view");
    const ViewsStage::Input in{.view = frame.settings.view,
                               .camera = frame.camera,
                               .points = frame.points,
                               .radiance = frame.radiance,
                               .exposure = frame.settings.exposure,
                               .tonemap = frame.settings.tonemap,
                               .budget = frame.settings.sample_count};
    switch (in.view)
    {
    case gpu::kViewNormals:
    case gpu::kViewPositions:
        return views_.recordPoints(frame.rec, in);
    case gpu::kViewSamples:
        return views_.recordSamples(frame.rec, in, samples_.output());
    case gpu::kViewClusters:
    case gpu::kViewBudget:
        return views_.recordQuadtree(frame.rec, in, samples_.output(), samples_.quadtree());
    case gpu::kViewPhotons:
        return views_.recordPhotons(frame.rec, in, photon_tree_.output());
    case gpu::kViewTree:
        return views_.recordTree(frame.rec, in, photon_tree_.output());
    case gpu::kViewCut:
        return views_.recordCut(frame.rec, in, cut_.output());
    case gpu::kViewNonFinite:
        return views_.recordNonFinite(frame.rec, in);
    default:
        return; // kViewIrradiance: interpolation has left it
    }
}
