// The scale of what is visible, from which stages derive their lengths.
#pragma once
#include "runtime/scene_gpu.h"
#include "shaders/primary/primary.h"
#include "shaders/view_scale/view_scale.h"

class ViewScaleStage
{
public:
    ViewScaleStage(const Device& device, const SceneGpu& scene);

    /// Sets the scene's view scale, which every kernel after it reads.
    /// @param points gpu::ShadingPoint[point_count]
    void record(Recorder& rec, const Buffer& points, uint32_t point_count, const gpu::CameraParams& camera) const;
    /// Metres, of the last frame that has ended; 0 before the first.
    float lastDistance() const;

private:
    const SceneGpu& scene_;
    Kernel measure_;
    Buffer readback_; // gpu::ViewScale
};
