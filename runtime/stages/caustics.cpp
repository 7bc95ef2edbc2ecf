#include "runtime/stages/caustics.h"

CausticsStage::CausticsStage(const Device& device, const SceneGpu& scene)
    : apply_(device.kernel("caustics/apply", scene.constants()))
{
}

void CausticsStage::record(Recorder& rec, const PhotonTreeStage::Output& map, const Input& in) const
{
    const gpu::CausticsParams params{
        .point_count = in.point_count, .photon_count = in.photon_count, .radius = in.radius};
    rec.run(apply_, in.point_count, params,
            {{"Size", map.size},
             {"TreeNodes", map.tree.nodes()},
             {"Photons", map.photons},
             {"Points", in.points},
             {"Radiance", in.radiance}});
}
