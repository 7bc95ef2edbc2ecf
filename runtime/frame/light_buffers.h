// The light of a frame, by the term that its paths belong to (shaders/lib/terms.h).
#pragma once
#include "format/gpu_scene.h"
#include "runtime/gpu/recorder.h"
#include "shaders/compose/compose.h"

/// vec3[point_count] each, W/(m^2 sr): what every shading point shows of it. Stages add to what clear() left black.
struct LightBuffers
{
    /// @param has_caustics whether the scene sends any (SceneGpu::sendsCaustics()): without them nothing reads or writes `caustics`
    LightBuffers(const Device& device, uint32_t point_count, bool has_caustics);

    Buffer emission;     // also of the sky, in mirrors too
    Buffer sharp_direct; // of lights that come from one place: without noise
    Buffer direct;       // of all others
    Buffer indirect;
    Buffer glossy;
    Buffer caustics;

    /// Makes terms black. @param terms gpu::kLight* bits; emission, which is written and not added to, is left as it is
    void clear(Recorder& rec, uint32_t terms) const;
};
