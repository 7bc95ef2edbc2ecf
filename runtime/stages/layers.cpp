#include "runtime/stages/layers.h"

#include "runtime/stages/primary.h"

LayersStage::LayersStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels)
    : scene_(scene), add_(device.kernel("layers/add", scene.constants())),
      views_(device.array<gpu::FrameViews>("layers.views", 1)),
      sums_(device.array<gpu::LayerSums>("layers.sums", max_pixels))
{
}

void LayersStage::record(Recorder& rec, const FrameInfo& frame, const SurfaceBuffers& surface,
                         const LightBuffers& light, uint32_t terms) const
{
    const auto scope = rec.scope("layers");
    const gpu::CameraParams& camera = frame.camera;
    const gpu::FrameViews views{.now = camera, .last = frame.before.value_or(camera)};
    rec.write(views_, 0, std::as_bytes(std::span(&views, 1)));
    const gpu::LayersParams params{.pixel_count = camera.width * camera.height,
                                   .point_count = surface.point_count,
                                   .terms = terms,
                                   .adds = frame.stands(),
                                   .spread = camera.orthographic ? 0 : PrimaryStage::textureWidth(camera),
                                   .eye = camera.position,
                                   .forward = camera.forward,
                                   .has_last = frame.before.has_value()};
    rec.run(add_, params.pixel_count, params,
            {{"Points", surface.points},
             {"Emission", light.emission},
             {"SharpDirect", light.sharp_direct},
             {"Direct", light.direct},
             {"Indirect", light.indirect},
             {"Glossy", light.glossy},
             {"Caustics", light.caustics},
             {"Layers", sums_},
             {"Views", views_},
             {"LastCorners", scene_.lastCorners()}});
}
