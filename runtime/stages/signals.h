// A frame's light as signals for filters and histories, with surface guides and motion vectors.
#pragma once
#include "runtime/frame/frame_info.h"
#include "runtime/frame/light_buffers.h"
#include "runtime/frame/surface_buffers.h"
#include "runtime/scene_gpu.h"
#include "shaders/signals/signals.h"

struct SignalBuffers
{
    const Buffer& guides;        // gpu::SurfaceGuide[pixel_count], with a texel view
    const Buffer& last_guides;   // the same of the last record()
    const Buffer& motions;       // gpu::Motion[pixel_count]
    const Buffer& displacements; // vec3[pixel_count], metres that surfaces have moved by since, where `moves`
    bool moves;                  // surfaces can move
    const Buffer& direct;        // gpu::LightSignal[pixel_count], with a texel view
    const Buffer& glossy;        // likewise
};

class SignalsStage
{
public:
    SignalsStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels, const Scratch& scratch = {});

    /// @param terms gpu::kLight* bits: of `light` that is there
    SignalBuffers record(Recorder& rec, const FrameInfo& frame, const SurfaceBuffers& surface,
                         const LightBuffers& light, uint32_t terms);
    /// Turns a signal into light again. @param filtered the signal of `own` after filters, @param light vec3[point_count]
    void apply(Recorder& rec, const Buffer& own, const Buffer& filtered, const Buffer& light,
               uint32_t point_count) const;

    const Buffer& motions() const { return motions_; } // of the last record(), in scratch memory

private:
    const SceneGpu& scene_;
    Kernel prepare_, apply_;
    Buffer views_, motions_, direct_, glossy_, displacements_;
    std::array<Buffer, 2> guides_;
    uint32_t now_ = 0; // of guides_
};
