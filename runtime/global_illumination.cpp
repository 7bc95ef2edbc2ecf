#include "runtime/global_illumination.h"

#include "runtime/camera.h"
#include "shaders/lib/terms.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace
{
constexpr uint32_t kCausticBounces =
    2; // photons that a caustic path is given room for: one, and another behind a smooth layer

/// Of a wall that 12 rays to the rim may miss, a node's light passes 0.05 % at most.
constexpr uint32_t kRimProbes = 12;

/// Emissions that train the guide before the first frame. Behind a window one photon in a hundred arrives at first; from round to
/// round more do. The mean of a first frame of a room on a plain of 10 km varied by 16 % after one, by 9 %
/// after four and after eight (preset preview); with the default preset, and in Sponza, eight are noisier than four: a sharp
/// distribution leaves few photons elsewhere.
constexpr uint32_t kWarmUpRounds = 4;

/// Scratch memory from the signals on: they themselves, motion, and what histories are compared by.
uint64_t signalBytes(uint32_t width, uint32_t height)
{
    return uint64_t(width) * height * (2 * sizeof(gpu::LightSignal) + sizeof(gpu::Motion)) +
           HistoryStage::scratchBytes(width, height);
}

/// What aligning the buffers may cost.
constexpr uint64_t kPadding = 1 << 16;

constexpr float kGuideReach = 0.25f; // of the view distance: up to this far from their camera guided photons are reused

/// Progressive photon mapping: r_n^2 / r_0^2 = prod (i + 2/3) / (i + 1) over the n frames before (Hachisuka et al.
/// 2008; Knaus & Zwicker 2011), so that noise and bias vanish together.
float shrunkRadius(float radius, uint32_t frame)
{
    constexpr double kAlpha = 2.0 / 3.0;
    const double log_ratio = std::lgamma(frame + 1 + kAlpha) - std::lgamma(frame + 2.0) - std::lgamma(1 + kAlpha);
    return radius * float(std::exp(0.5 * log_ratio));
}

/// Whether mirrored light gets points of its own: where there is such light, and the device binds and dispatches two a pixel.
bool splitsMirrors(const Device& device, const SceneGpu& scene, uint64_t pixel_count)
{
    const VkPhysicalDeviceLimits& limits = device.limits();
    const uint64_t range =
        std::min<uint64_t>(limits.maxStorageBufferRange, limits.maxTexelBufferElements * kTexelBytes);
    const uint64_t threads = uint64_t(limits.maxComputeWorkGroupCount[0]) * gpu::kRaysGroupSize;
    return scene.hasSmoothLayers() && 2 * pixel_count <= std::min(range / sizeof(gpu::ShadingPoint), threads);
}

/// Caustic paths that there is room for: none start where nothing sends any.
uint32_t causticPaths(const SceneGpu& scene, const Settings& settings)
{
    return scene.sendsCaustics() ? settings.caustic_photons : 1;
}

/// Photons that a map of `wanted` has room for: no more than this device's buffers hold of what is made of each.
uint32_t photonCapacity(const Device& device, uint64_t wanted)
{
    const uint64_t range =
        std::min<uint64_t>(device.limits().maxStorageBufferRange, device.limits().maxTexelBufferElements * kTexelBytes);
    return uint32_t(std::min(wanted, range / std::max(2 * sizeof(gpu::CutNode), sizeof(gpu::PhotonSums))));
}

/// Scratch memory of the global photon map.
uint64_t mapBytes(const Device& device, const Settings& settings)
{
    const uint32_t capacity = photonCapacity(device, settings.photon_capacity);
    return PhotonStage::scratchBytes(settings.photon_count, capacity) + PhotonTreeStage::scratchBytes(device, capacity);
}

uint32_t causticCapacity(const Device& device, const SceneGpu& scene, const Settings& settings)
{
    return photonCapacity(device, uint64_t(causticPaths(scene, settings)) * kCausticBounces);
}
} // namespace

struct GlobalIllumination::Context
{
    Recorder& rec;
    const RayStage& rays;
    const FrameInfo& frame;
    const FramePlan& plan;
    const Settings& settings;
    const SurfaceBuffers& surface;
    uint32_t point_count;
    uint32_t seed;           // of this frame alone
    uint32_t placement_seed; // the same, of where irradiance samples are
};

Status GlobalIllumination::checkCounts(const VkPhysicalDeviceLimits& limits, uint64_t range, const Settings& settings)
{
    const auto tooLarge = [&](const char* names, uint64_t most) -> Status
    {
        return Error{ExitCode::kDevice,
                     fmt::format("{} is more than this device's buffers hold, {}; lower one of them", names, most)};
    };
    const uint64_t threads = uint64_t(limits.maxComputeWorkGroupCount[0]) * gpu::kRaysGroupSize;
    const uint64_t most_rays = std::min(range / sizeof(gpu::Ray), threads),
                   most_starts = range / sizeof(gpu::PhotonStart);
    if (settings.photon_count > most_starts)
        return tooLarge("photons.count", most_starts);
    if (settings.caustic_photons > most_starts)
        return tooLarge("caustics.photons", most_starts);
    if (uint64_t(settings.sample_count) * mostGatherRays(settings) > most_rays)
        return tooLarge("samples.count x gather.rays", most_rays);
    return Success{};
}

GlobalIllumination::GlobalIllumination(const Device& device, const SceneGpu& scene, const Settings& settings,
                                       uint32_t width, uint32_t height)
    : scene_(scene), width_(width), height_(height), has_specular_(scene.hasFeature(gpu::kFeatureSpecular)),
      has_caustic_targets_(scene.info().caustic_target_count > 0),
      has_mirrors_(has_caustic_targets_ || scene.hasFeature(gpu::kFeatureTransmission | gpu::kFeatureThin)),
      point_count_(width * height * (splitsMirrors(device, scene, width * height) ? 2 : 1)),
      scratch_(std::max(mapBytes(device, settings) +
                            DirectStage::scratchBytes(scene, width, height, point_count_ / (width * height)),
                        signalBytes(width, height)) +
               kPadding),
      map_scratch_(scratch_.stage()), caustic_scratch_(caustic_pool_.stage()), signals_scratch_(scratch_.stage()),
      light_(device, point_count_, scene.sendsCaustics()),
      photons_(device, scene, PhotonKind::kGlobal, settings.photon_count,
               photonCapacity(device, settings.photon_capacity), map_scratch_),
      caustic_photons_(device, scene, PhotonKind::kCaustic, causticPaths(scene, settings),
                       causticCapacity(device, scene, settings), caustic_scratch_),
      photon_tree_(device, "photon_tree", photonCapacity(device, settings.photon_capacity), map_scratch_),
      caustic_tree_(device, "caustic_tree", causticCapacity(device, scene, settings), caustic_scratch_),
      primary_(device, scene, width * height, point_count_ > width * height, map_scratch_.part()),
      view_scale_(device, scene),
      direct_(device, scene, width, height, point_count_ / (width * height), map_scratch_.part()), legs_(device),
      cut_(device, scene, photonCapacity(device, settings.photon_capacity), scratch_.stage()),
      samples_(device, width, height, settings.sample_count),
      gather_(device, scene, settings.sample_count, settings.gather_rays, mostGatherRays(settings), scratch_.stage()),
      interpolate_(device, settings.sample_count, point_count_), glossy_(device, scene, point_count_, scratch_.stage()),
      caustics_(device, scene, causticCapacity(device, scene, settings), caustic_scratch_),
      filter_(device, scene, settings, width, height, direct_.isNoisy() || has_specular_, signals_scratch_),
      compose_(device, width * height, signals_scratch_), views_(device, scene, width * height)
{
    if (GuideStage::helps(scene))
        guide_.emplace(device, scene, settings.photon_count);
}

FrameTraits GlobalIllumination::traits() const
{
    return {.has_specular = has_specular_,
            .has_caustics = scene_.sendsCaustics(),
            .has_mirrors = has_mirrors_,
            .reflects_roughly = scene_.reflectsRoughly(),
            .has_noisy_direct = direct_.isNoisy(),
            .has_guide = guide_.has_value(),
            .gathers_at_pixels = gather_.suitsPixels(point_count_),
            .pixel_rays = gather_.raysPerPixel(point_count_)};
}

const Buffer& GlobalIllumination::record(Recorder& rec, const RayStage& rays, const FrameInfo& frame,
                                         const Settings& settings)
{
    const FramePlan plan = planFrame(settings, traits(), frame);
    gpu::CameraParams placement = frame.camera;
    placement.seed = placement_seed_.value_or(frame.camera.seed);
    const SurfaceBuffers surface = primary_.output(placement);
    const Context c{.rec = rec,
                    .rays = rays,
                    .frame = frame,
                    .plan = plan,
                    .settings = settings,
                    .surface = surface,
                    .point_count = point_count_,
                    .seed = traceSeed(frame.camera.seed, frame.accumulated, gpu::kTermIndirect),
                    .placement_seed = traceSeed(placement.seed, frame.accumulated, gpu::kTermIndirect)};
    const bool photons_first = plan.makes_map && !needsViewScale(c);
    bool has_new_photons = photons_first && recordPhotons(c);
    light_.clear(rec, plan.lightTerms());
    primary_.record(rec, rays,
                    {.camera = placement, .specular_depth = settings.specular_depth, .emission = light_.emission});
    view_scale_.record(rec, surface.points, width_ * height_, frame.camera);
    if (plan.makes_map && !photons_first)
        has_new_photons = recordPhotons(c);
    if (plan.direct)
        recordDirect(c);
    if (plan.makes_map)
    {
        const PhotonTreeStage::Output map = recordMap(c, has_new_photons);
        const CutStage::Output cut = recordCut(c, map);
        std::optional<InterpolateStage::Sorted> samples;
        if (plan.gathers_at_pixels)
            recordPixelGather(c, map, cut);
        if (plan.gathers_at_samples)
            samples.emplace(recordGather(c, map, cut));
        if (plan.indirect && samples)
            recordIndirect(c, *samples);
        if (plan.glossy)
            recordGlossy(c, cut, samples ? &*samples : nullptr);
    }
    if (plan.caustics)
        recordCaustics(c);
    highlights_ = plan.remembers && plan.noisy_direct && frame.previous
                      ? direct_.recordHighlights(rec, surface.points, *frame.previous)
                      : nullptr;
    filter_.record(rec, frame, surface, light_, plan, settings, highlights_);
    const Buffer& picture = compose_.record(rec, light_, plan, width_ * height_, point_count_);
    if (layers_)
        layers_->record(rec, frame, surface, light_, plan.lightTerms());
    if (settings.view != gpu::kViewNone)
        recordView(c, picture);
    return picture;
}

void GlobalIllumination::recordDirect(const Context& c)
{
    direct_.record(c.rec, c.rays,
                   {.points = c.surface.points,
                    .radiance = light_.sharp_direct,
                    .noisy = light_.direct,
                    .point_count = c.point_count,
                    .light_sample_count = c.settings.direct_samples,
                    .candidate_count = c.settings.direct_candidates,
                    .first_sample = c.frame.accumulated,
                    .seed = c.frame.camera.seed});
}

PhotonStage::Input GlobalIllumination::photonInput(const Context& c) const
{
    return {.path_count = c.settings.photon_count,
            .first_path = c.frame.accumulated * c.settings.photon_count,
            .seed = c.frame.map_seed,
            .guide = guide_ ? &*guide_ : nullptr};
}

/// Photons of a frame that follows another do with the view's scale of that one: they take few threads and fly while the device
/// traces rays from the eye. The first ones cannot, nor can what trains the guide before them.
bool GlobalIllumination::needsViewScale(const Context& c) const
{
    return !(c.frame.previous || c.frame.stands()) || (guide_ && !guide_->hasLearned());
}

/// Trains the guide before the first frame: splats the first hits of gathering rays, then traces photons and learns which of them
/// arrive there.
void GlobalIllumination::warmUp(const Context& c)
{
    guide_->reset(c.rec);
    gather_.traceFirstHits(c.rec, c.rays, samples_.record(c.rec, c.rays, samplesInput(c)), gatherInput(c), *guide_);
    for (uint32_t round = 0; round < kWarmUpRounds; ++round)
    {
        PhotonStage::Input in = photonInput(c);
        in.seed =
            traceSeed(in.seed, round, gpu::kTermIndirect); // what is learned from the photons that are used is biased
        guide_->learn(c.rec, photons_.record(c.rec, c.rays, in));
    }
}

/// Whether the map described by `made` is the one that `in` would give; otherwise sets `made`. A static view uses other photons
/// in every frame.
bool GlobalIllumination::isThere(const Context& c, std::optional<MapOrigin>& made, const PhotonStage::Input& in) const
{
    const MapOrigin asked{.scene = scene_.version(), .in = in};
    if (c.settings.reuse_photons && made == asked)
        return true;
    made = asked;
    return false;
}

/// Guided photons suit the camera that they were emitted for: far from there new ones are needed.
bool GlobalIllumination::isFar(const Context& c) const
{
    const gpu::vec3 a = c.frame.camera.position, b = map_camera_;
    return guide_ && std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) > kGuideReach * view_scale_.lastDistance();
}

/// Photons of this frame. @return false: there are none, those of the last map will do
bool GlobalIllumination::recordPhotons(const Context& c)
{
    if (isFar(c))
        global_map_.reset();
    if (isThere(c, global_map_, photonInput(c)))
        return false;
    made_cut_.reset();
    caustic_map_.reset(); // its tree is sorted as seen from the camera, too
    map_camera_ = c.frame.camera.position;
    const auto scope = c.rec.scope("photons");
    if (guide_)
        guide_->followLights(c.rec);
    if (guide_ && !guide_->hasLearned())
        warmUp(c);
    photons_.record(c.rec, c.rays, photonInput(c));
    return true;
}

PhotonTreeStage::Output GlobalIllumination::recordMap(const Context& c, bool has_new_photons)
{
    if (!has_new_photons)
        return photon_tree_.output();
    const PhotonStage::Output photons = photons_.output(c.settings.photon_count);
    if (guide_)
    {
        const auto scope = c.rec.scope("photons");
        guide_->learn(c.rec, photons);
    }
    legs_.record(c.rec, photons, c.seed);
    const auto scope = c.rec.scope("photon tree");
    return photon_tree_.record(c.rec, photons);
}

CutStage::Output GlobalIllumination::recordCut(const Context& c, const PhotonTreeStage::Output& map)
{
    const Settings& settings = c.settings;
    const auto scope = c.rec.scope("cut");
    const float shrink = shrunkRadius(1, c.frame.accumulated);
    const CutStage::Input in{.mode = CutMode(settings.cut_mode),
                             .iterations = settings.cut_iterations,
                             .difference = settings.cut_difference,
                             .photon_count = settings.density_photons,
                             .radius = shrunkRadius(settings.density_radius, c.frame.accumulated),
                             .shrink = shrink,
                             .fewest = std::max(uint32_t(gpu::kCutFewest * shrink * shrink), 1u),
                             .probes = settings.cut_probes,
                             .rim_probes = kRimProbes,
                             .seed = traceSeed(c.frame.map_seed, c.frame.accumulated, gpu::kTermIndirect)};
    if (made_cut_ == in)
        return cut_.output();
    made_cut_ = in;
    return cut_.record(c.rec, c.rays, map, in);
}

SamplesStage::Input GlobalIllumination::samplesInput(const Context& c) const
{
    const Settings& settings = c.settings;
    return {.diffuse_points = c.surface.diffuse_points,
            .mode = SamplesMode(settings.samples_mode),
            .budget = settings.sample_count,
            .iterations = settings.sample_iterations,
            .alpha = settings.sample_alpha,
            .reach = settings.sample_reach,
            .seed = c.placement_seed};
}

GatherStage::Input GlobalIllumination::gatherInput(const Context& c) const
{
    const Settings& settings = c.settings;
    return {.mode = CutMode(settings.cut_mode),
            .ray_count = c.plan.gather_rays,
            .specular_depth = c.plan.chain_depth,
            .photon_count = settings.density_photons,
            .radius = settings.density_radius,
            .seed = c.seed,
            .legs = &legs_,
            .by_direction = c.plan.harmonics};
}

InterpolateStage::Sorted GlobalIllumination::recordGather(const Context& c, const PhotonTreeStage::Output& map,
                                                          const CutStage::Output& cut)
{
    const SamplesStage::Output samples = [&]
    {
        const auto scope = c.rec.scope("samples");
        return samples_.record(c.rec, c.rays, samplesInput(c));
    }();
    {
        const auto scope = c.rec.scope("gather");
        gather_.record(c.rec, c.rays, samples, map, cut, gatherInput(c), guide_ ? &*guide_ : nullptr);
    }
    const auto scope = c.rec.scope("interpolate");
    return interpolate_.sort(
        c.rec, samples,
        {.points = c.surface.points, .point_count = c.point_count, .width = width_, .by_direction = c.plan.harmonics});
}

void GlobalIllumination::recordIndirect(const Context& c, const InterpolateStage::Sorted& samples) const
{
    const auto scope = c.rec.scope("interpolate");
    interpolate_.record(c.rec, samples,
                        {.diffuse_points = c.surface.diffuse_points,
                         .radiance = light_.indirect,
                         .point_count = c.point_count,
                         .width = width_,
                         .alpha = c.settings.sample_alpha,
                         .white = c.settings.view == gpu::kViewIrradiance});
}

void GlobalIllumination::recordPixelGather(const Context& c, const PhotonTreeStage::Output& map,
                                           const CutStage::Output& cut)
{
    const auto scope = c.rec.scope("gather");
    gather_.recordPixels(c.rec, c.rays, map, cut, gatherInput(c),
                         {.points = c.surface.points,
                          .radiance = light_.indirect,
                          .point_count = c.point_count,
                          .frame = c.frame.accumulated,
                          .seed = traceSeed(c.frame.camera.seed, 0, gpu::kTermIndirect)},
                         guide_ ? &*guide_ : nullptr);
}

void GlobalIllumination::recordGlossy(const Context& c, const CutStage::Output& cut,
                                      const InterpolateStage::Sorted* samples) const
{
    const GlossyStage::Input in{.points = c.surface.points,
                                .radiance = light_.glossy,
                                .point_count = c.point_count,
                                .width = width_,
                                .first_sample = c.frame.accumulated,
                                .specular_depth = c.plan.chain_depth,
                                .seed = c.frame.camera.seed,
                                .roulette_threshold = c.plan.roulette_threshold,
                                .shared = c.plan.harmonics};
    const auto scope = c.rec.scope("glossy");
    if (in.shared)
        glossy_.recordHarmonics(c.rec, *samples, gather_.harmonics(), in);
    glossy_.record(c.rec, c.rays, cut, in);
}

void GlobalIllumination::recordCaustics(const Context& c)
{
    const Settings& settings = c.settings;
    const auto scope = c.rec.scope("caustics");
    // Without mirrors and glass to aim at there are only the faint reflections of smooth layers: few photons will do.
    const uint32_t path_count = has_caustic_targets_ ? settings.caustic_photons : settings.caustic_photons / 8;
    const PhotonStage::Input in{.path_count = path_count,
                                .first_path = c.frame.accumulated * path_count,
                                .seed = c.frame.map_seed + gpu::kTermCaustics};
    const CausticsStage::Input shown{.points = c.surface.points,
                                     .radiance = light_.caustics,
                                     .point_count = c.point_count,
                                     .camera = c.frame.camera,
                                     .photon_count = settings.caustic_density_photons,
                                     .radius = shrunkRadius(settings.caustic_radius, c.frame.accumulated)};
    const std::pair discs{shown.photon_count, shown.radius};
    if (std::exchange(discs_, discs) != discs)
        caustic_map_.reset(); // its tree holds the discs
    if (!isThere(c, caustic_map_, in))
        caustics_.spread(c.rec, caustic_tree_.record(c.rec, caustic_photons_.record(c.rec, c.rays, in)), shown);
    caustics_.apply(c.rec, caustic_tree_.output(), shown);
}

void GlobalIllumination::recordView(const Context& c, const Buffer& picture) const
{
    const auto scope = c.rec.scope("view");
    const ViewsStage::Input in{.view = c.settings.view,
                               .camera = c.frame.camera,
                               .points = c.surface.points,
                               .radiance = picture,
                               .exposure = c.settings.exposure,
                               .tonemap = c.settings.tonemap,
                               .budget = c.settings.sample_count};
    switch (in.view)
    {
    case gpu::kViewNormals:
    case gpu::kViewPositions:
        return views_.recordPoints(c.rec, in);
    case gpu::kViewSamples:
        return views_.recordSamples(c.rec, in, samples_.output());
    case gpu::kViewClusters:
    case gpu::kViewBudget:
        return views_.recordQuadtree(c.rec, in, samples_.output(), samples_.quadtree());
    case gpu::kViewPhotons:
        return views_.recordPhotons(c.rec, in, photon_tree_.output());
    case gpu::kViewTree:
        return views_.recordTree(c.rec, in, photon_tree_.output());
    case gpu::kViewCut:
        return views_.recordCut(c.rec, in, cut_.output());
    case gpu::kViewNonFinite:
        return views_.recordNonFinite(c.rec, in);
    default:
        return; // kViewIrradiance: interpolation has left it
    }
}
