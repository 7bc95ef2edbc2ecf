#include "runtime/frame/plan.h"

#include "shaders/lib/terms.h"
#include "shaders/views/views.h"

#include <algorithm>
#include <bit>

namespace
{
/// Russian-roulette thresholds of glossy rays: lower in a static view, where noise averages out.
constexpr float kThresholdMoving = 0.2f, kThresholdStatic = 0.05f;

/// A static view interpolates until every pixel could have had this many rays of its own (kLeastInterpolated frames at least),
/// then gathers at pixels: the blur of the first frames fades, and their lack of noise hides the noise of the next ones.
constexpr uint32_t kOwnRays = 256, kLeastInterpolated = 8;

/// A frame that has nothing to go on from may have this many gathering rays together, at most this many times those of others. With
/// the 12288 rays of preset `preview` the mean of Sponza's indirect light deviates by 12 % from one seed to the next, with eight
/// times as many by 5 % (10 seeds each); four times the photons or the probe rays change nothing.
constexpr uint32_t kFirstRays = 98304, kMostTimesRays = 8;

/// A picture of one term shows that alone; the view of the irradiance is made of the indirect light; other views draw over all.
bool shows(const Settings& settings, uint32_t term)
{
    if (settings.view != gpu::kViewNone)
        return settings.view != gpu::kViewIrradiance || term == gpu::kTermIndirect;
    return settings.term == gpu::kTermAll || settings.term == term;
}

/// A static view needs the filter less with every frame: for four times the samples one pass less, until none is left and the
/// picture converges. Histories spare a pass, too.
uint32_t denoisePasses(const Settings& settings, const FrameTraits& traits, const FrameInfo& frame)
{
    const uint32_t fewer =
        uint32_t(std::bit_width(frame.accumulated + 1)) / 2 + (frame.previous && settings.history_frames > 0 ? 1 : 0);
    const bool noisy = traits.has_noisy_direct || traits.has_specular;
    return noisy && settings.view == gpu::kViewNone && settings.denoise_passes > fewer ? settings.denoise_passes - fewer
                                                                                       : 0;
}
} // namespace

bool goesOn(const Settings& settings)
{
    return settings.view == gpu::kViewNone && (settings.history_frames > 0 || settings.antialias_frames > 0);
}

uint32_t mostGatherRays(const Settings& settings)
{
    const uint64_t usual = uint64_t(settings.sample_count) * settings.gather_rays;
    // Without histories every frame of a moving camera is a first one.
    return settings.gather_rays *
           (settings.history_frames > 0
                ? std::clamp(uint32_t(kFirstRays / std::max<uint64_t>(usual, 1)), 1u, kMostTimesRays)
                : 1);
}

FramePlan planFrame(const Settings& settings, const FrameTraits& traits, const FrameInfo& frame)
{
    FramePlan plan{};
    plan.emission = shows(settings, gpu::kTermEmission);
    plan.direct = shows(settings, gpu::kTermDirect);
    plan.noisy_direct = plan.direct && traits.has_noisy_direct;
    plan.indirect = shows(settings, gpu::kTermIndirect);
    plan.glossy = traits.has_specular && shows(settings, gpu::kTermGlossy);
    plan.caustics = traits.has_caustics && shows(settings, gpu::kTermCaustics);
    plan.makes_map = plan.indirect || plan.glossy;
    // Rough reflection is from the samples' harmonics in the first frame of a picture, with little noise; harmonics of order 4
    // lose detail, so that the frames after it trace rays.
    plan.harmonics = plan.glossy && traits.reflects_roughly &&
                     GlossyMode(settings.glossy_mode) == GlossyMode::kHarmonics && !frame.stands();
    // Interpolation blurs what is smaller than the distance of samples, however many frames it has.
    const bool own_rays = traits.gathers_at_pixels && settings.view != gpu::kViewIrradiance &&
                          frame.accumulated >= std::max(kOwnRays / traits.pixel_rays, kLeastInterpolated);
    const bool gathers =
        plan.makes_map && (plan.indirect || traits.has_guide); // the guide learns the same whatever is shown
    plan.gathers_at_pixels = gathers && own_rays;
    plan.gathers_at_samples = (gathers && !own_rays) || plan.harmonics;
    plan.gather_rays = frame.previous || frame.stands() ? settings.gather_rays : mostGatherRays(settings);
    // Each costs rays a pass over a mostly empty queue. Without mirrors and glass there are only smooth layers over something
    // diffuse, whose third reflections are too faint to matter.
    plan.chain_depth = traits.has_mirrors    ? settings.specular_depth
                       : traits.has_caustics ? std::min(settings.specular_depth, 2u)
                                             : 0;
    plan.denoise_passes = denoisePasses(settings, traits, frame);
    plan.remembers = settings.history_frames > 0 && goesOn(settings) && !frame.stands();
    plan.antialiases = settings.antialias_frames > 0 && goesOn(settings) && !frame.stands();
    plan.roulette_threshold = frame.stands() ? kThresholdStatic : kThresholdMoving;
    return plan;
}
