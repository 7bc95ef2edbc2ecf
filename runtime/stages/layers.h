// Layers: what each term of a picture is, and what the camera sees first, beside the picture itself.
#pragma once
#include "runtime/frame/frame_info.h"
#include "runtime/frame/light_buffers.h"
#include "runtime/frame/surface_buffers.h"
#include "runtime/scene_gpu.h"
#include "shaders/layers/layers.h"

class LayersStage
{
public:
    LayersStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels);

    /// Adds a frame to those of its standing picture, or begins anew. @param terms gpu::kLight* bits that it made
    void record(Recorder& rec, const FrameInfo& frame, const SurfaceBuffers& surface, const LightBuffers& light,
                uint32_t terms) const;

    const Buffer& sums() const { return sums_; } // gpu::LayerSums[width * height]

private:
    const SceneGpu& scene_;
    Kernel add_;
    Buffer views_, sums_;
};
