// Every setting of the renderer, declared once: name, default, unit, range, help. --set, --help and the panel follow from it.
#pragma once
#include "format/result.h"
#include "runtime/choices.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>

struct Settings
{
    uint32_t specular_depth = 8;
    uint32_t direct_samples = 1;
    uint32_t direct_candidates = 8;
    uint32_t photon_count = 50000; // paths
    uint32_t photon_capacity = 400000;
    uint32_t density_photons = 16;
    float density_radius = 0.07f; // of the distance from the viewer
    uint32_t cut_mode = gpu::kCutRefined;
    uint32_t cut_probes = 16;
    uint32_t cut_iterations = 0;
    float cut_difference = 0.2f;
    uint32_t samples_mode = uint32_t(SamplesMode::kKmeans);
    uint32_t sample_count = 4096;
    uint32_t sample_iterations = 1;
    float sample_alpha = 10;
    float sample_reach = 4;
    uint32_t gather_rays = 256;
    uint32_t glossy_mode = uint32_t(GlossyMode::kHarmonics);
    uint32_t caustic_photons = 100000; // paths
    uint32_t caustic_density_photons = 200;
    float caustic_radius = 0.03f; // of the distance from the viewer
    uint32_t denoise_passes = 3;
    uint32_t history_frames = 32;
    uint32_t antialias_frames = 6;
    uint32_t reuse_photons = 0; // 0 or 1
    uint32_t reference_depth = 64;
    uint32_t term = gpu::kTermAll;
    uint32_t view = gpu::kViewNone;
    float exposure = 0;
    uint32_t tonemap = gpu::kTonemapAgx;

    bool operator==(const Settings&) const = default;
};

/// Settings of a preset: preview (for CPUs and slow GPUs), default, high. @return kUsage listing the presets
Result<Settings> presetSettings(std::string_view name);

struct Setting
{
    std::string_view name;
    std::variant<uint32_t Settings::*, float Settings::*> member;
    double least, most;
    std::string_view unit; // "" for counts
    std::string_view help;
    std::span<const Choice> choices = {}; // of least..most, where the setting is a choice
};

std::span<const Setting> allSettings();

/// The names of its choices with `separator` in between.
std::string choiceNames(const Setting& setting, std::string_view separator);

/// A preset with assignments applied in order. @return kUsage naming the valid names or the range
Result<Settings> makeSettings(std::string_view preset, std::span<const std::string> assignments);

/// Applies "name=value". @return kUsage naming the valid names or the range
Status applySetting(Settings& settings, const std::string& assignment);

/// "specular_depth = 8 (0..64): help", a line a setting, for --help.
std::string describeSettings();
