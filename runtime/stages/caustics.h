// Caustics: light that mirrors and glass focus on diffuse surfaces, straight from the caustic photon map.
#pragma once
#include "runtime/stages/photon_tree.h"
#include "shaders/caustics/caustics.h"

class CausticsStage
{
public:
    /// @param max_photons capacity of the map
    CausticsStage(const Device& device, const SceneGpu& scene, uint32_t max_photons, const Scratch& scratch = {});

    struct Input
    {
        const Buffer& points;            // gpu::ShadingPoint[point_count]
        const Buffer& radiance;          // vec3[point_count], grows by the caustics
        uint32_t point_count;            // a whole number of rows
        const gpu::CameraParams& camera; // that saw them
        uint32_t photon_count;           // k: photons that spread their light over one point, about
        float radius;                    // over which a photon spreads it at most: of the distance from the viewer
    };
    /// Spreads the light of a new map's photons over discs, which its tree holds from then on.
    void spread(Recorder& rec, const PhotonTreeStage::Output& map, const Input& in) const;
    /// Adds the light of the discs of the last spread().
    void apply(Recorder& rec, const PhotonTreeStage::Output& map, const Input& in) const;

    /// float[map.size.count], squared radii of the discs of the last spread(), metres.
    const Buffer& supports() const { return supports_; }

private:
    Kernel spread_kernel_, apply_kernel_;
    Buffer spheres_, supports_;
};
