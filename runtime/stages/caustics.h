// Caustics: light that mirrors and glass focus on diffuse surfaces, straight from the caustic photon map.
#pragma once
#include "runtime/stages/photon_tree.h"
#include "shaders/caustics/caustics.h"

class CausticsStage
{
public:
    CausticsStage(const Device& device, const SceneGpu& scene);

    struct Input
    {
        const Buffer& points;   // gpu::ShadingPoint[point_count]
        const Buffer& radiance; // vec3[point_count], grows by the caustics
        uint32_t point_count;
        uint32_t photon_count; // k of the density estimation
        float radius;          // of the density estimation at most: of the distance from the viewer
    };
    void record(Recorder& rec, const PhotonTreeStage::Output& map, const Input& in) const;

private:
    Kernel apply_;
};
