// The plan of a frame of mode gi, made before any of it is recorded.
#pragma once
#include "runtime/frame/frame_info.h"
#include "runtime/frame/light_buffers.h"
#include "runtime/settings.h"

/// Properties of the scene and of the allocated buffers that a plan depends on.
struct FrameTraits
{
    bool has_specular = false; // mirrors, glass, rough reflection
    bool has_caustics = false; // mirrors, glass or smooth layers send light to other surfaces, whose paths follow them
    bool has_mirrors = false;  // delta events that are more than the sheen of a smooth layer
    bool reflects_roughly = false;  // some reflection is so rough that spherical harmonics can replace rays
    bool has_noisy_direct = false;  // lights with an area, or several of them: a ray samples a part
    bool has_guide = false;         // photons are guided
    bool gathers_at_pixels = false; // there is room for gathering rays of every pixel
    uint32_t pixel_rays = 1;        // of each, a frame
};

struct FramePlan
{
    bool emission, direct, indirect, glossy, caustics; // terms that the frame shows
    bool noisy_direct;                                 // direct light that one ray samples only in part
    bool makes_map;                                    // photons, their tree and the cut are needed
    bool gathers_at_samples;  // final gathering at irradiance samples, between which pixels interpolate
    bool gathers_at_pixels;   // final gathering at every pixel instead
    bool harmonics;           // rough reflection is computed from the samples' harmonics where they suffice
    uint32_t gather_rays;     // of a sample
    uint32_t chain_depth;     // delta events that gathering rays follow
    uint32_t denoise_passes;  // of the filter over what is noisy; 0: none
    bool remembers;           // light is averaged with histories, and histories are updated
    bool antialiases;         // the picture is blended with the last one
    float roulette_threshold; // Russian-roulette threshold of glossy rays

    /// gpu::kLight* bits of the terms that the frame makes.
    uint32_t lightTerms() const
    {
        return (emission ? gpu::kLightEmission : 0u) | (direct ? gpu::kLightSharpDirect : 0u) |
               (direct && noisy_direct ? gpu::kLightDirect : 0u) | (indirect ? gpu::kLightIndirect : 0u) |
               (glossy ? gpu::kLightGlossy : 0u) | (caustics ? gpu::kLightCaustics : 0u);
    }
    bool operator==(const FramePlan&) const = default;
};

/// Whether frames of such settings may go on from what the frame before them found.
bool goesOn(const Settings& settings);

/// Most gathering rays of an irradiance sample: those of a frame that has nothing to go on from.
uint32_t mostGatherRays(const Settings& settings);

FramePlan planFrame(const Settings& settings, const FrameTraits& traits, const FrameInfo& frame);
