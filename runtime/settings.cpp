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
consteval Knob choice(std::string_view name, uint32_t Settings::* member, std::span<const Choice> choices, std::string_view help)
{
    return {name, member, 0, double(choices.size() - 1), "", help, choices};
}

constexpr std::array kKnobs{
    Knob{"specular_depth", &Settings::specular_depth, 0, 64, "", "mirror and glass events followed from the eye"},
    Knob{"direct_samples", &Settings::direct_samples, 1, 64, "", "shadow rays a pixel and frame, to suns, skies and lamps each"},
    Knob{"direct_candidates", &Settings::direct_candidates, 1, 64, "", "light samples of which one gets the shadow ray"},
    Knob{"photons.count", &Settings::photon_count, 256, 4e6, "", "photon paths emitted a frame"},
    Knob{"photons.capacity", &Settings::photon_capacity, 256, 8e6, "", "photons that a map has room for; where bright surfaces leave more, fewer paths are emitted"},
    Knob{"photons.nearest", &Settings::density_photons, 8, 1024, "", "photons of a density estimate"},
    Knob{"photons.radius", &Settings::density_radius, 1e-4, 10, "of the distance from the viewer", "how far a density estimate may reach"},
    choice("cut.mode", &Settings::cut_mode, kCutModes, "how gather rays read the photons"),
    Knob{"cut.iterations", &Settings::cut_iterations, 0, 16, "", "rounds of refinement of the illumination cut"},
    Knob{"cut.difference", &Settings::cut_difference, 0, 10, "", "relative difference of irradiance that refinement lets pass"},
    Knob{"cut.probes", &Settings::cut_probes, 0, 64, "", "coverage probe rays of a node of the cut"},
    choice("samples.mode", &Settings::samples_mode, kSamplesModes, "how irradiance samples are placed"),
    Knob{"samples.count", &Settings::sample_count, 16, 65536, "", "irradiance samples a frame"},
    Knob{"samples.iterations", &Settings::sample_iterations, 0, 16, "", "iterations of k-means"},
    Knob{"samples.alpha", &Settings::sample_alpha, 0.01, 1000, "per view distance", "weight of distance against normals"},
    Knob{"samples.reach", &Settings::sample_reach, 2, 10, "of its cluster's mean radius", "how far a sample speaks for"},
    Knob{"gather.rays", &Settings::gather_rays, 1, 4096, "",
         "rays an irradiance sample gathers with; times samples.count, also those of a standing picture's pixels"},
    choice("glossy.mode", &Settings::glossy_mode, kGlossyModes, "rough reflections of a picture's first frame"),
    Knob{"caustics.photons", &Settings::caustic_photons, 256, 4e6, "", "photon paths aimed at specular objects a frame"},
    Knob{"caustics.nearest", &Settings::caustic_density_photons, 8, 1024, "", "photons of a caustic's density estimate"},
    Knob{"caustics.radius", &Settings::caustic_radius, 1e-4, 1, "of the distance from the viewer", "how far that estimate may reach"},
    Knob{"denoise.passes", &Settings::denoise_passes, 0, 5, "", "passes of the filter over the first frames' noise, each three times as wide as the last"},
    Knob{"history.frames", &Settings::history_frames, 0, 62, "", "frames that a moving picture's light is the mean of at most; 0: each stands alone"},
    Knob{"antialias.frames", &Settings::antialias_frames, 0, 62, "", "frames that a moving picture's edges are the mean of at most; 0: none but its own"},
    choice("reuse.photons", &Settings::reuse_photons, kOffOn, "whether photons and cut are kept while only the camera moves"),
    Knob{"reference_depth", &Settings::reference_depth, 1, 1024, "", "most vertices of a path of the reference"},
    choice("term", &Settings::term, kTerms, "light paths shown in modes gi and reference; the others sum to all"),
    choice("view", &Settings::view, kViews, "what mode gi shows in place of the picture"),
    Knob{"exposure", &Settings::exposure, -20, 20, "stops", "brightness of the display; EXR files stay linear"},
    choice("tonemap", &Settings::tonemap, kTonemaps, "display transform"),
};

std::optional<double> parseValue(const Knob& knob, std::string_view text)
{
    if (const auto chosen = std::ranges::find(knob.choices, text, &Choice::name); chosen != knob.choices.end())
        return double(chosen->value);
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size() || !knob.choices.empty())
        return std::nullopt;
    const bool whole = std::holds_alternative<uint32_t Settings::*>(knob.member);
    const bool in_range = value >= knob.least && value <= knob.most; // not so for NaN
    return in_range && (!whole || value == std::floor(value)) ? std::optional(value) : std::nullopt;
}

std::string rangeOf(const Knob& knob)
{
    const char* kind = std::holds_alternative<uint32_t Settings::*>(knob.member) ? "a whole number" : "a number";
    return knob.choices.empty() ? fmt::format("{} in {}..{}", kind, knob.least, knob.most) : fmt::format("one of {}", choiceNames(knob, ","));
}
} // namespace

std::span<const Knob> knobs() { return kKnobs; }

std::string choiceNames(const Knob& knob, std::string_view separator)
{
    std::string names;
    for (const Choice& choice : knob.choices)
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
    const auto knob = std::ranges::find(kKnobs, name, &Knob::name);
    if (equals == std::string::npos || knob == kKnobs.end())
    {
        std::string names;
        for (const Knob& k : kKnobs)
            names += fmt::format("{}{}", names.empty() ? "" : ", ", k.name);
        return Error{ExitCode::kUsage, fmt::format("--set {}: name=value is expected, with name one of {}", assignment, names)};
    }
    const std::optional<double> value = parseValue(*knob, std::string_view(assignment).substr(equals + 1));
    if (!value)
        return Error{ExitCode::kUsage, fmt::format("--set {}: {} must be {}", assignment, name, rangeOf(*knob))};
    std::visit([&](auto member) { settings.*member = std::remove_reference_t<decltype(settings.*member)>(*value); }, knob->member);
    return Success{};
}

std::string describeKnobs()
{
    const Settings defaults;
    std::string text;
    for (const Knob& knob : kKnobs)
    {
        std::string value = std::visit([&](auto member) { return fmt::format("{}", defaults.*member); }, knob.member);
        if (!knob.choices.empty())
            value = knob.choices[std::stoul(value)].name;
        text += fmt::format("  {} = {}{}{}  {}; {}\n", knob.name, value, knob.unit.empty() ? "" : " ", knob.unit, knob.help, rangeOf(knob));
    }
    return text;
}
