// Smooth edges: the picture as the mean of this frame and of those before, moved to where things are now.
#pragma once
#include "runtime/gpu/gpu.h"
#include "shaders/antialias/antialias.h"

#include <array>
#include <optional>

class AntialiasStage
{
public:
    AntialiasStage(const Device& device, uint32_t max_pixels);

    /// What highlights of lamps do as the eye moves.
    struct Highlights
    {
        const Buffer& direct;  // vec3[width * height]: the part of the picture that changes
        const Buffer& factors; // float[width * height]: by what, since the last frame
    };

    /// Of a frame that is the first of its picture.
    /// @param picture vec3[width * height]; @param motions gpu::Motion[width * height], kNoMotion where there is nothing to go on
    /// from; @param continues whether the last frame shown may serve
    /// @param factor by which that frame's picture is multiplied
    void recordMoving(Recorder& rec, const Buffer& picture, const Buffer& motions, uint32_t width, uint32_t height,
                      uint32_t most_frames, bool continues, gpu::vec3 factor = {1, 1, 1},
                      const std::optional<Highlights>& highlights = {});
    /// Of a frame that adds to a static view: its mean, with the picture of the moving camera fading out so that nothing jumps.
    /// @param sum vec3[point_count] of `frames` frames
    void recordStanding(Recorder& rec, const Buffer& sum, uint32_t frames, uint32_t point_count);

    /// vec3[point_count]: what the last frame shows.
    const Buffer& shown() const { return shown_[latest_]; }

private:
    Kernel blend_, stand_;
    Buffer no_direct_, no_factors_;
    std::array<Buffer, 2> shown_;      // vec3[max_pixels]
    std::array<Buffer, 2> counts_;     // float[max_pixels]: frames in the mean of shown_
    uint32_t moving_ = 0, latest_ = 0; // of shown_: the last moving picture, and what is shown
    uint32_t moving_counts_ = 0;       // of counts_
    uint32_t moved_frames_ = 0;        // that the moving picture is made of
};
