// Camera rays and their specular chains: one shading point a pixel, or two.
#pragma once
#include "runtime/frame/surface_buffers.h"
#include "runtime/stages/rays.h"
#include "shaders/primary/primary.h"

class PrimaryStage
{
public:
    /// Of a pixel: what textures are blurred over, a little less than one sample a pixel can show.
    static constexpr float kTextureBlur = 0.7f;

    /// Of a ray at distance 1, metres (perspective), or of every ray (orthographic). In a static view each
    /// frame covers its own part of a pixel, so that textures become sharp.
    static float textureWidth(const gpu::CameraParams& camera);

    /// @param splits whether mirrored light gets points of its own; otherwise reflection or transmission is chosen at random
    PrimaryStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels, bool splits = false,
                 const Scratch& scratch = {});

    struct Input
    {
        gpu::CameraParams camera; // with sample_count 1
        uint32_t specular_depth;  // most specular events in a chain
        const Buffer& emission;   // vec3[points] becomes what the chains themselves find: emitters, sky
    };
    SurfaceBuffers record(Recorder& rec, const RayStage& rays, const Input& in) const;
    /// What the last record() left, or the next one will.
    SurfaceBuffers output(const gpu::CameraParams& camera) const;

private:
    bool has_delta_lobes_, splits_;
    Kernel trace_, chain_, follow_;
    RayQueue queue_; // the rays that go on from the first vertex
    Buffer hits_, points_, diffuse_points_;
};
