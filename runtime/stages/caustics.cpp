#include "runtime/stages/caustics.h"

#include "runtime/camera.h"

CausticsStage::CausticsStage(const Device& device, const SceneGpu& scene, uint32_t max_photons, const Scratch& scratch)
    : spread_kernel_(device.kernel("caustics/spread")),
      apply_kernel_(device.kernel("caustics/apply", scene.constants())),
      spheres_(device.array<gpu::vec4>("caustics.spheres", max_photons, scratch)),
      supports_(device.array<float>("caustics.supports", max_photons))
{
}

void CausticsStage::spread(Recorder& rec, const PhotonTreeStage::Output& map, const Input& in) const
{
    const float pixel = pixelSide(in.camera);
    rec.runIndirect(spread_kernel_, map.size,
                    gpu::SpreadPhotonsParams{.photon_count = in.photon_count,
                                             .radius = in.radius,
                                             .pixel_angle = in.camera.orthographic ? 0 : pixel,
                                             .pixel_side = in.camera.orthographic ? pixel : 0,
                                             .eye = in.camera.position},
                    {{"Size", map.size},
                     {"TreeNodes", map.tree.nodes()},
                     {"Photons", map.photons},
                     {"Order", map.tree.order()},
                     {"Spheres", spheres_},
                     {"Supports", supports_},
                     {"LeafParents", map.tree.leafParents()},
                     {"NodeParents", map.tree.nodeParents()}});
    map.tree.refit(rec, spheres_, map.size);
}

void CausticsStage::apply(Recorder& rec, const PhotonTreeStage::Output& map, const Input& in) const
{
    rec.run(apply_kernel_, in.point_count, gpu::CausticsParams{.point_count = in.point_count, .width = in.camera.width},
            {{"Size", map.size},
             {"TreeNodes", map.tree.nodes()},
             {"Photons", map.photons},
             {"Supports", supports_},
             {"Points", in.points},
             {"Radiance", in.radiance}});
}
