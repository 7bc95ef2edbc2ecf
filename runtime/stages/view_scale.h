// The scale of what is visible, from which stages derive their lengths.
#pragma once
#include "runtime/scene_gpu.h"
#include "shaders/primary/primary.h"
#include "shaders/view_scale/view_scale.h"

#include <array>

class ViewScaleStage
{
public:
    ViewScaleStage(const Device& device, const SceneGpu& scene);

    /// Sets the scene's view scale, which every kernel after it reads.
    /// @param points gpu::ShadingPoint[point_count]
    void record(Recorder& rec, const Buffer& points, uint32_t point_count, const gpu::CameraParams& camera);
    /// Metres, of the frame kFramesInFlight before the last record(), which has surely ended; 0 where there was none.
    float lastDistance() const { return last_distance_; }

private:
    const SceneGpu& scene_;
    Kernel measure_;
    std::array<Buffer, kFramesInFlight> readbacks_; // gpu::ViewScale, of frames in turn
    uint32_t turn_ = 0;
    float last_distance_ = 0;
};
