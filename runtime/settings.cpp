#include "runtime/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

namespace
{
consteval Setting choice(std::string_view name, uint32_t Settings::*member, std::span<const Choice> choices,
                         std::string_view help)
{
    return {name, member, 0, double(choices.size() - 1), "", help, choices};
}

constexpr std::array kSettings{
    Setting{"specular_depth", &Settings::specular_depth, 0, 64, "", "mirror and glass events followed from the eye"},
    Setting{"direct_samples", &Settings::direct_samples, 1, 64, "",
            "shadow rays a pixel and frame, to directional, environment and local lights each"},
    Setting{"direct_candidates", &Settings::direct_candidates, 1, 64, "",
            "light samples of which one is chosen for the shadow ray"},
    Setting{"photons.count", &Settings::photon_count, 256, 4e6, "", "photon paths emitted a frame"},
    Setting{"photons.capacity", &Settings::photon_capacity, 256, 8e6, "",
            "photons that a map can hold; where bright surfaces would store more, fewer paths are emitted"},
    Setting{"photons.nearest", &Settings::density_photons, 8, 1024, "", "photons of a density estimate"},
    Setting{"photons.radius", &Settings::density_radius, 1e-4, 10, "of the distance from the viewer",
            "largest radius of a density estimate"},
    choice("cut.mode", &Settings::cut_mode, kCutModes, "how gather rays read the photons"),
    Setting{"cut.iterations", &Settings::cut_iterations, 0, 16, "", "rounds of refinement of the illumination cut"},
    Setting{"cut.difference", &Settings::cut_difference, 0, 10, "",
            "relative difference of irradiance that refinement accepts"},
    Setting{"cut.probes", &Settings::cut_probes, 0, 64, "", "coverage probe rays of a node of the cut"},
    choice("samples.mode", &Settings::samples_mode, kSamplesModes, "how irradiance samples are placed"),
    Setting{"samples.count", &Settings::sample_count, 16, 65536, "", "irradiance samples a frame"},
    Setting{"samples.iterations", &Settings::sample_iterations, 0, 16, "", "iterations of k-means"},
    Setting{"samples.alpha", &Settings::sample_alpha, 0.01, 1000, "per view distance",
            "weight of distance against normals"},
    Setting{"samples.reach", &Settings::sample_reach, 2, 10, "of its cluster's mean radius",
            "influence radius of a sample"},
    Setting{"gather.rays", &Settings::gather_rays, 1, 4096, "",
            "rays an irradiance sample gathers with; times samples.count, also those of a static view's pixels"},
    choice("glossy.mode", &Settings::glossy_mode, kGlossyModes, "rough reflections of the first frame of a view"),
    Setting{"caustics.photons", &Settings::caustic_photons, 256, 4e6, "",
            "photon paths aimed at specular objects a frame"},
    Setting{"caustics.nearest", &Settings::caustic_density_photons, 8, 1024, "",
            "photons that a caustic photon spreads its light over the disc of"},
    Setting{"caustics.radius", &Settings::caustic_radius, 1e-4, 1, "of the distance from the viewer",
            "largest radius of such a disc"},
    Setting{"denoise.passes", &Settings::denoise_passes, 0, 5, "",
            "passes of the filter over the first frames' noise, each three times as wide as the last"},
    Setting{"history.frames", &Settings::history_frames, 0, 62, "",
            "most frames in the mean of a pixel's light while the camera moves; 0: each frame by itself"},
    Setting{"antialias.frames", &Settings::antialias_frames, 0, 62, "",
            "most frames in the mean of a pixel's edges while the camera moves; 0: each frame by itself"},
    choice("reuse.photons", &Settings::reuse_photons, kOffOn,
           "whether photons and cut are kept while only the camera moves"),
    Setting{"reference_depth", &Settings::reference_depth, 1, 1024, "", "most vertices of a path of the reference"},
    choice("term", &Settings::term, kTerms, "light paths shown in modes gi and reference; the others sum to all"),
    choice("view", &Settings::view, kViews, "debug view that mode gi shows in place of the picture"),
    Setting{"exposure", &Settings::exposure, -20, 20, "stops", "brightness of the display; EXR files stay linear"},
    choice("tonemap", &Settings::tonemap, kTonemaps, "display transform"),
};

std::optional<double> parseValue(const Setting& setting, std::string_view text)
{
    if (const auto chosen = std::ranges::find(setting.choices, text, &Choice::name); chosen != setting.choices.end())
        return double(chosen->value);
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size() || !setting.choices.empty())
        return std::nullopt;
    const bool whole = std::holds_alternative<uint32_t Settings::*>(setting.member);
    const bool in_range = value >= setting.least && value <= setting.most; // not so for NaN
    return in_range && (!whole || value == std::floor(value)) ? std::optional(value) : std::nullopt;
}

std::string rangeOf(const Setting& setting)
{
    const char* kind = std::holds_alternative<uint32_t Settings::*>(setting.member) ? "a whole number" : "a number";
    return setting.choices.empty() ? fmt::format("{} in {}..{}", kind, setting.least, setting.most)
                                   : fmt::format("one of {}", choiceNames(setting, ","));
}
} // namespace

std::span<const Setting> allSettings()
{
    return kSettings;
}

std::string choiceNames(const Setting& setting, std::string_view separator)
{
    std::string names;
    for (const Choice& choice : setting.choices)
        names.append(names.empty() ? "" : separator).append(choice.name);
    return names;
}

Result<Settings> presetSettings(std::string_view name)
{
    Settings settings;
    if (name == "preview")
    {
        settings.direct_candidates = 4;
        settings.photon_count = 6000;
        settings.photon_capacity = 48000;
        settings.cut_probes = 8;
        settings.sample_count = 384;
        settings.sample_reach = 3.5f;
        settings.gather_rays = 32;
        settings.denoise_passes = 2;
        settings.caustic_photons = 4000;
        settings.caustic_density_photons = 24;
    }
    else if (name == "high")
    {
        settings.direct_samples = 4;
        settings.photon_count = 200000;
        settings.photon_capacity = 1600000;
        settings.sample_count = 16384;
        settings.gather_rays = 512;
        settings.caustic_photons = 400000;
    }
    else if (name != "default")
        return Error{ExitCode::kUsage, fmt::format("--preset {}: the presets are preview, default and high", name)};
    return settings;
}

Result<Settings> makeSettings(std::string_view preset, std::span<const std::string> assignments)
{
    Result<Settings> settings = presetSettings(preset);
    for (const std::string& assignment : assignments)
        if (settings)
            if (const Status status = applySetting(*settings, assignment); !status)
                return status.error();
    return settings;
}

Status applySetting(Settings& settings, const std::string& assignment)
{
    const size_t equals = assignment.find('=');
    const std::string name = assignment.substr(0, equals);
    const auto setting = std::ranges::find(kSettings, name, &Setting::name);
    if (equals == std::string::npos || setting == kSettings.end())
    {
        std::string names;
        for (const Setting& k : kSettings)
            names += fmt::format("{}{}", names.empty() ? "" : ", ", k.name);
        return Error{ExitCode::kUsage,
                     fmt::format("--set {}: name=value is expected, with name one of {}", assignment, names)};
    }
    const std::optional<double> value = parseValue(*setting, std::string_view(assignment).substr(equals + 1));
    if (!value)
        return Error{ExitCode::kUsage, fmt::format("--set {}: {} must be {}", assignment, name, rangeOf(*setting))};
    std::visit([&](auto member) { settings.*member = std::remove_reference_t<decltype(settings.*member)>(*value); },
               setting->member);
    return Success{};
}

std::string describeSettings()
{
    const Settings defaults;
    std::string text;
    for (const Setting& setting : kSettings)
    {
        std::string value =
            std::visit([&](auto member) { return fmt::format("{}", defaults.*member); }, setting.member);
        if (!setting.choices.empty())
            value = setting.choices[std::stoul(value)].name;
        text += fmt::format("  {} = {}{}{}  {}; {}\n", setting.name, value, setting.unit.empty() ? "" : " ",
                            setting.unit, setting.help, rangeOf(setting));
    }
    return text;
}
