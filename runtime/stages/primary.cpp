#include "runtime/stages/primary.h"

#include "runtime/camera.h"

PrimaryStage::PrimaryStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels, bool splits,
                           const Scratch& scratch)
    : has_delta_lobes_(scene.hasFeature(gpu::kFeatureDeltaLobes)), splits_(splits),
      generate_(device.kernel("primary/generate")), chain_(device.kernel("primary/chain", scene.constants())),
      queue_(device, "primary.queue", max_pixels * (splits ? 2 : 1), scratch),
      next_queue_(device, "primary.next_queue", max_pixels * (splits ? 2 : 1), scratch),
      hits_(device.texelArray<gpu::Hit>("primary.hits", max_pixels * (splits ? 2 : 1), scratch)),
      points_(device.texelArray<gpu::ShadingPoint>("primary.points", max_pixels * (splits ? 2 : 1))),
      diffuse_points_(device.texelArray<gpu::DiffusePoint>("primary.diffuse_points", max_pixels * (splits ? 2 : 1)))
{
}

/// Of a pixel: what each frame of a moving picture shows of it. The frames are blended, which blurs once more.
constexpr float kMovingShare = 0.5f;

float PrimaryStage::textureWidth(const gpu::CameraParams& camera)
{
    const float share = camera.jitter.x > 0 ? kMovingShare : 1 / float(camera.first_sample + 1);
    return kTextureBlur * pixelSide(camera) * share;
}

SurfaceBuffers PrimaryStage::record(Recorder& rec, const RayStage& rays, const Input& in) const
{
    const auto scope = rec.scope("primary");
    const uint32_t pixel_count = in.camera.width * in.camera.height;
    rays.resize(rec, queue_.size, pixel_count);
    rec.run(generate_, pixel_count, in.camera, {{"Rays", queue_.rays}});

    const RayQueue* queue = &queue_;
    const RayQueue* next = &next_queue_;
    const float width = textureWidth(in.camera);
    const uint32_t depth_limit = has_delta_lobes_ ? in.specular_depth : 0;
    for (uint32_t depth = 0; depth <= depth_limit; ++depth)
    {
        const gpu::ChainParams params{.depth = depth,
                                      .depth_limit = depth_limit,
                                      .splits = splits_ && depth == 0,
                                      .pixel_count = pixel_count,
                                      .first_sample = in.camera.first_sample,
                                      .seed = in.camera.seed,
                                      .width = in.camera.orthographic ? width : 0,
                                      .spread = in.camera.orthographic ? 0 : width,
                                      .eye = in.camera.position};
        rays.closest(rec, *queue, hits_, traceSeed(in.camera.seed, in.camera.first_sample, depth));
        rays.reset(rec, next->size);
        rec.runIndirect(chain_, queue->size, params,
                        {{"Queue", queue->size},
                         {"Rays", queue->rays},
                         {"Hits", hits_},
                         {"Points", points_},
                         {"Radiance", in.emission},
                         {"NextQueue", next->size},
                         {"NextRays", next->rays},
                         {"DiffusePoints", diffuse_points_}});
        rays.close(rec, next->size);
        std::swap(queue, next);
    }
    return {.points = points_, .diffuse_points = diffuse_points_, .point_count = pixel_count * (splits_ ? 2 : 1)};
}
