#include "runtime/stages/layers.h"

#include "runtime/stages/primary.h"

LayersStage::LayersStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels)
    : add_(device.kernel("layers/add", scene.constants())),
      sums_(device.array<gpu::LayerSums>("layers.sums", max_pixels))
{
}

void LayersStage::record(Recorder& rec, const FrameInfo& frame, const SurfaceBuffers& surface,
                         const LightBuffers& light, uint32_t terms) const
{
    const auto scope = rec.scope("layers");
    const gpu::CameraParams& camera = frame.camera;
    const gpu::LayersParams params{.pixel_count = camera.width * camera.height,
                                   .point_count = surface.point_count,
                                   .terms = terms,
                                   .adds = frame.stands(),
                                   .spread = camera.orthographic ? 0 : PrimaryStage::textureWidth(camera),
                                   .eye = camera.position,
                                   .forward = camera.forward};
    rec.run(add_, params.pixel_count, params,
            {{"Points", surface.points},
             {"Emission", light.emission},
             {"SharpDirect", light.sharp_direct},
             {"Direct", light.direct},
             {"Indirect", light.indirect},
             {"Glossy", light.glossy},
             {"Caustics", light.caustics},
             {"Layers", sums_}});
}
