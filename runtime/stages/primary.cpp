#include "runtime/stages/primary.h"

#include "runtime/camera.h"

PrimaryStage::PrimaryStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels, bool splits,
                           const Scratch& scratch)
    : has_delta_lobes_(scene.hasFeature(gpu::kFeatureDeltaLobes)), splits_(splits),
      trace_(device.kernel("primary/trace", scene.constants())),
      chain_(device.kernel("primary/chain", scene.constants())),
      follow_(device.kernel("primary/follow", scene.constants())),
      queue_(device, "primary.queue", has_delta_lobes_ ? max_pixels * (splits ? 2 : 1) : 1, scratch),
      hits_(device.texelArray<gpu::Hit>("primary.hits", max_pixels, scratch)),
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
    const float width = textureWidth(in.camera);
    const gpu::ChainParams params{.camera = in.camera,
                                  .depth_limit = has_delta_lobes_ ? in.specular_depth : 0,
                                  .splits = splits_,
                                  .width = in.camera.orthographic ? width : 0,
                                  .spread = in.camera.orthographic ? 0 : width,
                                  .trace_seed = traceSeed(in.camera.seed, in.camera.first_sample, 0)};
    rays.count(rec, pixel_count);
    rec.run(trace_, pixel_count, params, {{"Hits", hits_}});
    rays.reset(rec, queue_.size);
    rec.run(chain_, pixel_count, params,
            {{"Hits", hits_},
             {"Points", points_},
             {"DiffusePoints", diffuse_points_},
             {"Radiance", in.emission},
             {"NextQueue", queue_.size},
             {"NextRays", queue_.rays}});
    if (params.depth_limit > 0)
    {
        rays.close(rec, queue_.size);
        rays.count(rec, queue_.size);
        rec.runIndirect(follow_, queue_.size, params,
                        {{"Queue", queue_.size},
                         {"Rays", queue_.rays},
                         {"Points", points_},
                         {"DiffusePoints", diffuse_points_},
                         {"Radiance", in.emission}});
    }
    return output(in.camera);
}

SurfaceBuffers PrimaryStage::output(const gpu::CameraParams& camera) const
{
    return {.points = points_,
            .diffuse_points = diffuse_points_,
            .point_count = camera.width * camera.height * (splits_ ? 2 : 1)};
}
