#include "tools/bench/changing_lights.h"

#include "tools/bench/paths.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <xxhash.h>

namespace
{
bool alike(gpu::vec3 a, gpu::vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

gpu::vec3 times(gpu::vec3 a, gpu::vec3 b)
{
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// The lights of the source that light `index` belongs to.
std::vector<uint32_t> sourceOf(std::span<const gpu::Light> lights, uint32_t index)
{
    std::vector<uint32_t> members;
    for (uint32_t i = 0; i < lights.size(); ++i)
        if (i == index || (lights[i].kind == gpu::kLightTriangle && lights[index].kind == gpu::kLightTriangle &&
                           alike(lights[i].emission, lights[index].emission)))
            members.push_back(i);
    return members;
}

std::vector<uint32_t> firstSource(std::span<const gpu::Light> lights)
{
    std::vector<uint32_t> first;
    float most = 0;
    for (uint32_t i = 0; i < lights.size(); ++i)
    {
        const std::vector<uint32_t> members = sourceOf(lights, i);
        const float power = std::accumulate(members.begin(), members.end(), 0.0f,
                                            [&](float sum, uint32_t light) { return sum + lights[light].pmf; });
        if (members.front() == i && power > most)
        {
            most = power;
            first = members;
        }
    }
    return first;
}

/// What a light's power is multiplied by.
gpu::vec3 factorOf(LightChange change, int32_t frame, int32_t off_frame)
{
    const float wave = std::sin(float(frame) * 2 * std::numbers::pi_v<float> / 30);
    if (change == LightChange::kOff)
        return frame < off_frame ? gpu::vec3{1, 1, 1} : gpu::vec3{};
    if (change == LightChange::kTint) // luminance 0.2126 r + 0.7152 g + 0.0722 b stays
        return {1 + 0.3f * wave, 1, 1 - 0.3f * wave * 0.2126f / 0.0722f};
    const float factor = std::exp2(wave);
    return {factor, factor, factor};
}
} // namespace

std::optional<uint32_t> chooseMovingLight(std::span<const gpu::Light> lights)
{
    std::optional<uint32_t> chosen;
    for (uint32_t i = 0; i < lights.size(); ++i)
    {
        if (lights[i].kind == gpu::kLightDirectional)
            return i;
        if (!chosen && (lights[i].kind == gpu::kLightPoint || lights[i].kind == gpu::kLightSpot))
            chosen = i;
    }
    return chosen;
}

Result<ChangingLights> ChangingLights::create(const OpenedPackage& opened, LightChange change, int32_t off_frame)
{
    ChangingLights result(opened, change, off_frame);
    if (change == LightChange::kSteady)
        return result;
    const auto lights = opened.package.lights();
    if (change == LightChange::kOrbit)
    {
        const auto moving = chooseMovingLight(lights);
        if (!moving)
            return Error{ExitCode::kInvalid, "no light can move: there is no directional, point or spot light"};
        result.lights_ = {*moving};
        return result;
    }
    if (change == LightChange::kPulse)
    {
        result.lights_.resize(lights.size());
        std::iota(result.lights_.begin(), result.lights_.end(), 0u);
    }
    else
        result.lights_ = firstSource(lights);
    if (result.lights_.empty())
        return Error{ExitCode::kInvalid, "no light can change: there is none"};
    const gpu::Light& first = lights[result.lights_.front()];
    const auto materials = opened.package.materials();
    for (uint32_t i = 0; i < materials.size(); ++i)
        if (dot(materials[i].emission, {1, 1, 1}) > 0 &&
            (change == LightChange::kPulse ||
             (first.kind == gpu::kLightTriangle && alike(materials[i].emission, first.emission))))
            result.materials_.push_back(i);
    return result;
}

void ChangingLights::scale(Recorder& rec, gpu::vec3 factor)
{
    std::vector<ChangedLight> changed;
    for (const uint32_t i : lights_)
    {
        changed.push_back({i, opened_->package.lights()[i]});
        changed.back().light.emission = times(changed.back().light.emission, factor);
    }
    opened_->scene->setLights(rec, changed);
    for (const uint32_t i : materials_)
        opened_->scene->setEmission(rec, i, times(opened_->package.materials()[i].emission, factor));
    hash_ = XXH3_64bits_withSeed(&factor, sizeof(factor), uint64_t(change_) + 1);
}

void ChangingLights::set(Recorder& rec, int32_t frame)
{
    if (change_ == LightChange::kSteady)
        return;
    if (change_ == LightChange::kOff && frame != off_frame_)
        return; // nothing else changes
    if (change_ != LightChange::kOrbit)
        return scale(rec, factorOf(change_, frame, off_frame_));
    const gpu::Light moved = movedLight(opened_->package.lights()[lights_[0]], opened_->scene->info(), frame);
    opened_->scene->setLight(rec, lights_[0], moved);
    hash_ = XXH3_64bits_withSeed(&moved, sizeof(moved), uint64_t(change_) + 1);
}

void ChangingLights::restore(Recorder& rec)
{
    if (change_ == LightChange::kSteady)
        return;
    if (change_ == LightChange::kOrbit)
        opened_->scene->setLight(rec, lights_[0], opened_->package.lights()[lights_[0]]);
    else
        scale(rec, {1, 1, 1});
    hash_ = 0;
}
