#include "runtime/filtered_paths.h"

#include "shaders/lib/terms.h"

FilteredPaths::FilteredPaths(const Device& device, const SceneGpu& scene, const Settings& settings, uint32_t width,
                             uint32_t height)
    : width_(width), height_(height), has_specular_(scene.hasFeature(gpu::kFeatureSpecular)),
      light_(device, width * height, scene.sendsCaustics()), primary_(device, scene, width * height),
      paths_(device, scene, width * height, 1), filter_(device, scene, settings, width, height, true),
      compose_(device, width * height)
{
}

namespace
{
FramePlan planOf(const Settings& settings, const FrameInfo& frame, bool has_specular)
{
    FramePlan plan = planFrame(settings, {.has_specular = has_specular, .has_noisy_direct = true}, frame);
    plan.direct = plan.noisy_direct = settings.term != gpu::kTermEmission;
    plan.indirect = plan.glossy = plan.caustics = false;
    return plan;
}
} // namespace

const Buffer& FilteredPaths::record(Recorder& rec, const RayStage& rays, const FrameInfo& frame,
                                    const Settings& settings)
{
    const FramePlan plan = planOf(settings, frame, has_specular_);
    light_.clear(rec, plan.lightTerms());
    gpu::CameraParams camera = frame.camera;
    camera.sample_count = 1;
    const SurfaceBuffers surface = primary_.record(
        rec, rays, {.camera = camera, .specular_depth = settings.specular_depth, .emission = light_.emission});
    if (plan.direct)
    {
        const Buffer& found = paths_.record(
            rec, rays,
            {.camera = camera, .depth_limit = settings.reference_depth, .term = settings.term, .emission = false});
        rec.copy(found, light_.direct, uint64_t(width_) * height_ * sizeof(gpu::vec3));
    }
    filter_.record(rec, frame, surface, light_, plan, settings);
    return compose_.record(rec, light_, plan, width_ * height_, width_ * height_);
}
