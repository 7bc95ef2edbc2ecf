#include "runtime/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace
{
constexpr uint64_t kLargestPixelBytes = sizeof(gpu::ShadingPoint); // of any stage's buffer
static_assert(kLargestPixelBytes >= sizeof(gpu::ShadowRay) && kLargestPixelBytes >= sizeof(gpu::Ray));

/// Places within the pixel that fill it evenly however many successive ones are taken (Roberts 2018, the R2 sequence).
gpu::vec2 jitterOf(uint32_t frame)
{
    const auto part = [&](double step) { return float(std::fmod(0.5 + step * frame, 1.0)); };
    return {part(0.7548776662466927), part(0.5698402909980532)};
}

/// Frames in the mean that smooths edges. Where pixels' light changes each by itself, nothing tells the mean of it: two frames let
/// it follow. Where geometry moves, most of the picture does not change, and would lose its smooth edges for nothing.
uint32_t mostAntialiased(const FrameInfo& frame, const Settings& settings)
{
    constexpr uint32_t kMostWhereLightChanges = 2;
    const bool unknown = frame.lights_alone && frame.light_range && !frame.light_range->isOneFactor();
    return unknown ? std::min(settings.antialias_frames, kMostWhereLightChanges) : settings.antialias_frames;
}

bool onlyLightsChanged(const SceneVersion& a, const SceneVersion& b)
{
    return a.geometry == b.geometry && a.materials == b.materials;
}

bool sameView(const gpu::CameraParams& a, const gpu::CameraParams& b)
{
    return std::memcmp(&a, &b, sizeof(a)) == 0; // both from cameraParams(): sampling fields are equal
}
} // namespace

uint32_t Renderer::batchFor(const Device& device, uint32_t pixel_count)
{
    constexpr uint32_t kPathsToFill = 1u << 20;
    return device.isCpu() ? 1 : std::clamp(kPathsToFill / pixel_count, 1u, 64u);
}

Status Renderer::checkSize(const Device& device, uint32_t width, uint32_t height, Mode mode, const Settings& settings)
{
    const uint64_t range =
        std::min<uint64_t>(device.limits().maxStorageBufferRange, device.limits().maxTexelBufferElements * kTexelBytes);
    const uint64_t most = range / kLargestPixelBytes;
    if (uint64_t(width) * height <= most)
        return mode == Mode::kGi ? GlobalIllumination::checkCounts(device.limits(), range, settings) : Success{};
    return Error{ExitCode::kDevice,
                 fmt::format("a picture of {}x{} is too large for {}, which takes {:.1f} million pixels", width, height,
                             device.name(), double(most) * 1e-6)};
}

Renderer::Renderer(const Device& device, const SceneGpu& scene, Mode mode, uint32_t width, uint32_t height,
                   const Settings& settings)
    : scene_(scene), width_(width), height_(height),
      max_batch_(mode == Mode::kReference ? batchFor(device, width * height) : 1), rays_(device, scene),
      resolve_(device, width * height), last_scene_(scene.version())
{
    if (mode == Mode::kReference)
        reference_.emplace(device, scene, width * height, max_batch_);
    else if (mode == Mode::kGi)
        gi_.emplace(device, scene, settings, width, height);
    else if (mode == Mode::kFilteredPaths)
        paths_.emplace(device, scene, settings, width, height);
    else
    {
        primary_.emplace(device, scene, width * height);
        direct_.emplace(device, scene, width, height, 1);
        direct_light_ = device.array<gpu::vec3>("renderer.direct_light", width * height);
    }
    if (!remembers())
        return;
    last_emitters_ = scene.emitters();
    if (settings.antialias_frames > 0)
        antialias_.emplace(device, width * height);
}

/// What this frame continues: a static view if neither camera nor lights have changed, else the last frame only, as far as its
/// light may serve.
FrameInfo Renderer::beginFrame(Recorder& rec, const Camera& camera, const Settings& settings, uint32_t seed)
{
    FrameInfo frame{.camera = cameraParams(camera, width_, height_), .map_seed = seed, .number = frame_count_++};
    frame.camera.seed = seed;
    const bool goes_on = remembers() && goesOn(settings);
    const bool scene_stands = last_scene_ == scene_.version();
    if (!last_camera_ || !scene_stands || !sameView(*last_camera_, frame.camera))
    {
        resolve_.restart(rec);
        frame.before = last_camera_;
        if (went_on_ && goes_on)
            frame.previous = last_camera_;
        frame.lights_alone = !scene_stands && onlyLightsChanged(last_scene_, scene_.version());
        if (frame.previous && !scene_stands)
            frame.light_range =
                frame.lights_alone ? lightRange(last_emitters_, scene_.emitters()) : LightRange::anything();
        picture_seed_ =
            frame.previous ? traceSeed(seed, frame.number, 0) : seed; // means need other numbers in every frame
        went_on_ = goes_on;
    }
    last_camera_ = frame.camera;
    frame.camera.seed = picture_seed_;
    if (!settings.reuse_photons)
        frame.map_seed = picture_seed_;
    if (frame.previous && antialias_)
        frame.camera.jitter = jitterOf(frame.number);
    if (remembers() && !scene_stands)
        last_emitters_ = scene_.emitters();
    last_scene_ = scene_.version();
    const bool repeat = gi_ && showsOneFrame(settings.view); // a debug view stands still
    frame.accumulated = repeat ? 0 : resolve_.sampleCount();
    frame.camera.first_sample = frame.accumulated;
    return frame;
}

void Renderer::changeLights(Recorder& rec, SceneGpu& scene, std::span<const ChangedLight> changed)
{
    check(&scene == &scene_, "lights of another scene than the renderer's");
    scene.setLights(rec, changed);
}

void Renderer::record(Recorder& rec, const Camera& camera, const Settings& settings, uint32_t seed,
                      uint32_t sample_count)
{
    check(sample_count >= 1 && sample_count <= max_batch_, "{} samples in a frame of at most {}", sample_count,
          max_batch_);
    shows_error_ = gi_ && error_ && settings.view == gpu::kViewError;
    Settings drawn = settings;
    if (settings.view == gpu::kViewError) // lies over the picture
        drawn.view = gpu::kViewNone;
    FrameInfo frame = beginFrame(rec, camera, drawn, seed);
    if (remembers())
        return recordRemembering(rec, frame, drawn);
    if (!reference_)
        return recordDirect(rec, frame, settings);
    frame.camera.sample_count = sample_count;
    const Buffer& radiance = reference_->record(
        rec, rays_, {.camera = frame.camera, .depth_limit = settings.reference_depth, .term = settings.term});
    resolve_.accumulate(rec, radiance, width_ * height_, sample_count);
}

void Renderer::recordDirect(Recorder& rec, const FrameInfo& frame, const Settings& settings)
{
    const SurfaceBuffers surface = primary_->record(
        rec, rays_, {.camera = frame.camera, .specular_depth = settings.specular_depth, .emission = direct_light_});
    direct_->record(rec, rays_,
                    {.points = surface.points,
                     .radiance = direct_light_,
                     .noisy = direct_light_,
                     .point_count = width_ * height_,
                     .light_sample_count = settings.direct_samples,
                     .candidate_count = settings.direct_candidates,
                     .first_sample = frame.accumulated,
                     .seed = frame.camera.seed});
    resolve_.accumulate(rec, direct_light_, width_ * height_, 1);
}

void Renderer::recordRemembering(Recorder& rec, const FrameInfo& frame, const Settings& settings)
{
    const Buffer& picture =
        gi_ ? gi_->record(rec, rays_, frame, settings) : paths_->record(rec, rays_, frame, settings);
    resolve_.accumulate(rec, picture, width_ * height_, 1);
    is_antialiased_ = antialias_ && settings.view == gpu::kViewNone && settings.antialias_frames > 0;
    if (is_antialiased_ && frame.stands())
        antialias_->recordStanding(rec, resolve_.sum(), resolve_.sampleCount(), width_ * height_);
    else if (is_antialiased_)
        antialias_->recordMoving(rec, picture, gi_ ? gi_->motions() : paths_->motions(), width_, height_,
                                 mostAntialiased(frame, settings), frame.previous.has_value(),
                                 frame.light_range ? frame.light_range->surely() : gpu::vec3{1, 1, 1},
                                 gi_ ? gi_->highlights() : std::nullopt);
    if (shows_error_)
        error_->record(rec, resolve_.sum(), resolve_.sampleCount(), width_, height_);
}

void Renderer::compareWith(const Device& device, std::span<const gpu::vec3> reference, uint32_t width, uint32_t height)
{
    error_.emplace(device, reference, width, height, width_ * height_);
}

const Buffer& Renderer::display(Recorder& rec, const Settings& settings, bool bgra)
{
    if (shows_error_)
        return resolve_.displayColors(rec, error_->colors(), width_ * height_, bgra);
    if (is_antialiased_)
        return resolve_.display(rec, antialias_->shown(), 1, width_ * height_, settings.exposure,
                                Tonemap(settings.tonemap), bgra);
    if (gi_ && settings.view != gpu::kViewError && isDisplayReferred(settings.view))
        return resolve_.display(rec, width_ * height_, 0, Tonemap::kSrgb, bgra);
    return resolve_.display(rec, width_ * height_, settings.exposure, Tonemap(settings.tonemap), bgra);
}

std::vector<gpu::vec3> Renderer::picture(const Device& device) const
{
    if (shows_error_)
        return device.download<gpu::vec3>(error_->colors(), uint64_t(width_) * height_);
    if (is_antialiased_)
        return device.download<gpu::vec3>(antialias_->shown(), uint64_t(width_) * height_);
    std::vector<gpu::vec3> pixels = device.download<gpu::vec3>(resolve_.sum(), uint64_t(width_) * height_);
    const float scale = 1.0f / float(std::max(resolve_.sampleCount(), 1u));
    for (gpu::vec3& pixel : pixels)
        pixel = scale * pixel;
    return pixels;
}

uint32_t Renderer::nonFiniteCount(const Device& device) const
{
    return device.download<uint32_t>(resolve_.nonFiniteCount(), 1)[0];
}
