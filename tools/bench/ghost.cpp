#include "tools/bench/ghost.h"

#include "shaders/lib/terms.h"

namespace
{
constexpr uint32_t kLastFrame = Ghost::kFrames.back();
using Light = std::array<double, kLastFrame + 1>; // by frames since the last one that was lit

/// Replaces every light and emission by `factor`, 0 or 1, times what the package has.
void setLights(Recorder& rec, const OpenedPackage& opened, float factor)
{
    std::vector<ChangedLight> lights;
    for (const gpu::Light& light : opened.package.lights())
    {
        lights.push_back({uint32_t(lights.size()), light});
        lights.back().light.emission = factor * light.emission;
    }
    opened.scene->setLights(rec, lights);
    const auto materials = opened.package.materials();
    for (uint32_t i = 0; i < materials.size(); ++i)
        if (dot(materials[i].emission, {1, 1, 1}) > 0)
            opened.scene->setEmission(rec, i, factor * materials[i].emission);
}

double sumOf(const ImageF& picture)
{
    double sum = 0;
    for (const float value : picture.rgb)
        sum += double(value);
    return sum;
}

/// Of one term, in the last lit frame and the dark ones after it.
Light measure(const OpenedPackage& opened, const MotionBenchOptions& options, const CameraOfFrame& camera,
              uint32_t term)
{
    Settings settings = options.settings;
    settings.term = term;
    Renderer renderer(*opened.device, *opened.scene, modeOf(options), options.width, options.height, settings);
    Recorder rec(*opened.device);
    Light light{};
    for (int32_t frame = -int32_t(options.warm_up); frame <= int32_t(kLastFrame); ++frame)
    {
        rec.begin(opened.scene->descriptorSet());
        if (frame == 1)
            setLights(rec, opened, 0);
        renderer.record(rec, camera(frame), settings, frameSeed(options, frame));
        rec.submitAndWait();
        if (frame >= 0)
            light[size_t(frame)] = sumOf(pictureOf(renderer, *opened.device));
    }
    rec.begin(opened.scene->descriptorSet());
    setLights(rec, opened, 1);
    rec.submitAndWait();
    return light;
}

Ghost::Shares sharesOf(const Light& light)
{
    Ghost::Shares shares;
    for (size_t i = 0; i < shares.size(); ++i)
        if (light[0] > 0)
            shares[i] = light[Ghost::kFrames[i]] / light[0];
    return shares;
}
} // namespace

Ghost measureGhost(const OpenedPackage& opened, const MotionBenchOptions& options, const CameraOfFrame& camera)
{
    Light all = measure(opened, options, camera, gpu::kTermAll);
    const Light emission = measure(opened, options, camera, gpu::kTermEmission);
    for (size_t frame = 0; frame < all.size(); ++frame)
        all[frame] -= emission[frame]; // of unlit surfaces there is some in the dark, too
    return {.all = sharesOf(all), .indirect = sharesOf(measure(opened, options, camera, gpu::kTermIndirect))};
}
