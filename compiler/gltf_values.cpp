#include "compiler/gltf_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

using nlohmann::json;

namespace
{
constexpr double kPi = std::numbers::pi;
constexpr double kUnbounded =
    1e30; // far above any use; its products with factors and areas are single-precision numbers
constexpr double kDefaultFov = kPi / 4;

bool isNumber(const json& value)
{
    return value.is_number() && std::isfinite(value.get<double>());
}

std::string shown(const json& value)
{
    return value.is_number() ? fmt::format("{:g}", value.get<double>())
                             : value.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 40);
}

/// Replaces a member's value and adds a warning; `stand_in` describes the new value.
void replace(const JsonPlace& place, const char* key, const json& value, const std::string& stand_in,
             Warnings& warnings)
{
    const json* old = place.find(key);
    const bool number = old != nullptr && isNumber(*old);
    warnings.push_back({number ? WarningKind::kOutOfRange : WarningKind::kMalformed,
                        old == nullptr ? place.pointer : place.at(key),
                        old == nullptr ? fmt::format("{} is missing", key)
                        : number       ? fmt::format("{} is {}, which is not allowed", key, shown(*old))
                                       : fmt::format("{} is {} and no number", key, shown(*old)),
                        stand_in});
    place.object[key] = value;
}

double numberOr(const JsonPlace& place, const char* key, double fallback)
{
    const json* value = place.find(key);
    return value != nullptr && isNumber(*value) ? value->get<double>() : fallback;
}

/// A positive number, else `fallback`.
void repairPositive(const JsonPlace& place, const char* key, double fallback, const std::string& stand_in,
                    Warnings& warnings)
{
    if (!(numberOr(place, key, 0) > 0))
        replace(place, key, fallback, stand_in, warnings);
}

/// Removes an optional member unless it is a number greater than `least`.
void repairOptional(const JsonPlace& place, const char* key, double least, const char* stand_in, Warnings& warnings)
{
    if (place.find(key) == nullptr || numberOr(place, key, least) > least)
        return;
    replace(place, key, 0, stand_in, warnings);
    place.object.erase(key);
}

void repairPerspective(const JsonPlace& lens, Warnings& warnings)
{
    const double yfov = numberOr(lens, "yfov", 0);
    if (yfov >= kPi && yfov < 180)
        replace(lens, "yfov", yfov * kPi / 180, "it is taken as degrees", warnings);
    else if (!(yfov > 0 && yfov < kPi))
        replace(lens, "yfov", kDefaultFov, "it is taken as 45 degrees", warnings);
    if (!(numberOr(lens, "znear", 0) > 0))
        replace(lens, "znear", 0, "nothing is cut off near the camera", warnings);
    repairOptional(lens, "zfar", numberOr(lens, "znear", 0), "nothing is cut off far away", warnings);
    repairOptional(lens, "aspectRatio", 0, "that of the picture counts", warnings);
}

void repairOrthographic(const JsonPlace& lens, Warnings& warnings)
{
    for (const char* key : {"xmag", "ymag"})
        if (const double value = numberOr(lens, key, 0); value < 0)
            replace(lens, key, -value, "it is taken without its sign", warnings);
    repairPositive(lens, "ymag", std::max(numberOr(lens, "xmag", 0), 0.0) > 0 ? numberOr(lens, "xmag", 1) : 1.0,
                   "it is taken as the other magnification, or 1", warnings);
    repairPositive(lens, "xmag", numberOr(lens, "ymag", 1), "it is taken as the other magnification", warnings);
    if (!(numberOr(lens, "znear", -1) >= 0))
        replace(lens, "znear", 0, "nothing is cut off near the camera", warnings);
    if (const double znear = numberOr(lens, "znear", 0); !(numberOr(lens, "zfar", 0) > znear))
        replace(lens, "zfar", znear + 1e9, "nothing is cut off far away", warnings);
}

void repairSpot(const JsonPlace& spot, Warnings& warnings)
{
    constexpr double kRounding = 1e-4;
    for (const char* key : {"innerConeAngle", "outerConeAngle"})
        repairNumber(spot, key, 0, 90, warnings);
    if (numberOr(spot, "outerConeAngle", 0) > kPi / 2 + kRounding)
    {
        replace(spot, "outerConeAngle", numberOr(spot, "outerConeAngle", 0) * kPi / 180,
                "both cone angles are taken as degrees", warnings);
        spot.object["innerConeAngle"] = numberOr(spot, "innerConeAngle", 0) * kPi / 180;
    }
    const double outer = std::min(numberOr(spot, "outerConeAngle", kPi / 4), kPi / 2);
    spot.object["outerConeAngle"] = outer;
    if (numberOr(spot, "innerConeAngle", 0) > outer)
        replace(spot, "innerConeAngle", outer, "it is taken as the outer angle: the rim is hard", warnings);
    else if (numberOr(spot, "innerConeAngle", 0) == outer)
        warnings.push_back({WarningKind::kOutOfRange, spot.at("innerConeAngle"),
                            "innerConeAngle is not smaller than outerConeAngle", "the rim is hard"});
}

/// What a material's numbers may be; names are unique over all extensions.
struct Range
{
    const char* key;
    size_t
        length; // 1: a number, else an array of so many numbers; 0: a number or three (two extensions share the name)
    double low;
    double high;
    bool keeps_more = false; // a greater number is wrong, but has a plain meaning
};

constexpr Range kRanges[] = {
    {"alphaCutoff", 1, 0, kUnbounded},
    {"anisotropyRotation", 1, -kUnbounded, kUnbounded},
    {"anisotropyStrength", 1, 0, 1},
    {"attenuationColor", 3, 0, 1},
    {"attenuationDistance", 1, 1e-20, kUnbounded},
    {"baseColorFactor", 4, 0, 1},
    {"clearcoatFactor", 1, 0, 1},
    {"clearcoatRoughnessFactor", 1, 0, 1},
    {"diffuseFactor", 4, 0, 1},
    {"diffuseTransmissionColorFactor", 3, 0, 1},
    {"diffuseTransmissionFactor", 1, 0, 1},
    {"dispersion", 1, 0, kUnbounded},
    {"emissiveFactor", 3, 0, 1, true},
    {"emissiveStrength", 1, 0, kUnbounded},
    {"glossinessFactor", 1, 0, 1},
    {"iridescenceFactor", 1, 0, 1},
    {"iridescenceIor", 1, 1, kUnbounded},
    {"iridescenceThicknessMaximum", 1, 0, kUnbounded},
    {"iridescenceThicknessMinimum", 1, 0, kUnbounded},
    {"metallicFactor", 1, 0, 1},
    {"roughnessFactor", 1, 0, 1},
    {"sheenColorFactor", 3, 0, 1},
    {"sheenRoughnessFactor", 1, 0, 1},
    {"specularColorFactor", 3, 0, kUnbounded},
    {"specularFactor", 0, 0, 1},
    {"thicknessFactor", 1, 0, kUnbounded},
    {"transmissionFactor", 1, 0, 1},
};

void repairFactor(const JsonPlace& place, const Range& range, Warnings& warnings)
{
    if (place.find(range.key) == nullptr)
        return;
    json& value = *place.find(range.key);
    const size_t length = range.length != 0 ? range.length : value.is_array() ? 3 : 1;
    if (length == 1)
    {
        repairNumber(place, range.key, range.low, range.high, warnings);
        return;
    }
    if (!repairNumbers(place, range.key, length, "its default counts", warnings))
        return;
    const json old = value;
    for (json& channel : value)
        channel = std::clamp(channel.get<double>(), range.low, range.keeps_more ? kUnbounded : range.high);
    const bool more =
        range.keeps_more && std::any_of(value.begin(), value.end(), [&](const json& v) { return v > range.high; });
    if (value != old || more)
        warnings.push_back({WarningKind::kOutOfRange, place.at(range.key),
                            fmt::format("{} is {}, outside {:g} to {:g}", range.key, shown(old), range.low, range.high),
                            more && value == old ? "it is taken as it is" : "the nearest allowed value counts"});
}
} // namespace

json* JsonPlace::find(const char* key) const
{
    const auto it = object.find(key);
    return it == object.end() ? nullptr : &*it;
}

std::string JsonPlace::at(std::string_view key) const
{
    std::string escaped;
    for (const char c : key.substr(0, 100))
        if (c == '~')
            escaped += "~0";
        else if (c == '/')
            escaped += "~1";
        else
            escaped += c;
    return pointer + "/" + escaped;
}

bool repairNumber(const JsonPlace& place, const char* key, double low, double high, Warnings& warnings)
{
    json* value = place.find(key);
    if (value == nullptr)
        return false;
    if (!isNumber(*value))
    {
        warnings.push_back({WarningKind::kMalformed, place.at(key),
                            fmt::format("{} is {} and no number", key, shown(*value)), "its default counts"});
        place.object.erase(key);
        return false;
    }
    const double nearest = std::clamp(value->get<double>(), low, high);
    if (nearest == value->get<double>())
        return true;
    warnings.push_back({WarningKind::kOutOfRange, place.at(key),
                        fmt::format("{} is {}, outside {:g} to {:g}", key, shown(*value), low, high),
                        "the nearest allowed value counts"});
    *value = nearest;
    return true;
}

bool repairNumbers(const JsonPlace& place, const char* key, size_t length, const char* stand_in, Warnings& warnings)
{
    const json* value = place.find(key);
    if (value == nullptr)
        return false;
    if (value->is_array() && value->size() == length && std::all_of(value->begin(), value->end(), isNumber))
        return true;
    warnings.push_back({WarningKind::kMalformed, place.at(key),
                        fmt::format("{} is not an array of {} numbers", key, length), stand_in});
    place.object.erase(key);
    return false;
}

bool repairCamera(const JsonPlace& camera, Warnings& warnings)
{
    const json* type = camera.find("type");
    for (const char* kind : {"perspective", "orthographic"})
    {
        json* lens = camera.find(kind);
        if (type == nullptr || *type != kind || lens == nullptr || !lens->is_object())
            continue;
        const JsonPlace place{*lens, camera.at(kind)};
        std::string_view(kind) == "perspective" ? repairPerspective(place, warnings)
                                                : repairOrthographic(place, warnings);
        return true;
    }
    warnings.push_back({WarningKind::kMalformed, camera.pointer,
                        type != nullptr && (*type == "perspective" || *type == "orthographic")
                            ? fmt::format("a camera has no {} parameters", type->get<std::string>())
                            : fmt::format("camera type {} does not exist", type == nullptr ? "\"\"" : shown(*type)),
                        "the camera is left out"});
    return false;
}

bool repairLight(const JsonPlace& light, Warnings& warnings)
{
    const json* type = light.find("type");
    if (type == nullptr || (*type != "point" && *type != "spot" && *type != "directional"))
    {
        warnings.push_back({WarningKind::kMalformed, light.pointer,
                            fmt::format("light type {} does not exist", type == nullptr ? "\"\"" : shown(*type)),
                            "the light is left out"});
        return false;
    }
    repairNumber(light, "intensity", 0, kUnbounded, warnings);
    repairFactor(light, {"color", 3, 0, 1, true}, warnings);
    repairOptional(light, "range", 0, "it reaches without end", warnings);
    if (light.find("range") != nullptr)
        warnings.push_back({WarningKind::kApproximated, light.at("range"), "a light's range is not honoured",
                            "it reaches without end"});
    if (*type != "spot")
        return true;
    json* spot = light.find("spot");
    if (spot == nullptr || !spot->is_object())
    {
        warnings.push_back(
            {WarningKind::kMalformed, light.pointer, "a spot light has no cone", "its angles are 0 and 45 degrees"});
        light.object["spot"] = json::object();
    }
    repairSpot({light.object["spot"], light.at("spot")}, warnings);
    return true;
}

void repairMaterialValues(const JsonPlace& material, Warnings& warnings)
{
    for (const Range& range : kRanges)
        repairFactor(material, range, warnings);
    if (repairNumber(material, "ior", 0, kUnbounded, warnings)) // 0 is allowed, and what lies between is not
        if (const double ior = numberOr(material, "ior", 1); ior > 0 && ior < 1)
            replace(material, "ior", 1, "it is taken as 1", warnings);
    if (const json* mode = material.find("alphaMode");
        mode != nullptr && *mode != "OPAQUE" && *mode != "MASK" && *mode != "BLEND")
    {
        warnings.push_back({WarningKind::kMalformed, material.at("alphaMode"),
                            fmt::format("alpha mode {} does not exist", shown(*mode)), "it is opaque"});
        material.object.erase("alphaMode");
    }
    if (const json* sides = material.find("doubleSided"); sides != nullptr && !sides->is_boolean())
    {
        warnings.push_back({WarningKind::kMalformed, material.at("doubleSided"),
                            "doubleSided is neither true nor false", "its default counts"});
        material.object.erase("doubleSided");
    }
    for (auto& [key, value] : material.object.items())
        if (value.is_object() && key != "extras")
            repairMaterialValues({value, material.at(key)}, warnings);
}

void repairSampler(const JsonPlace& sampler, Warnings& warnings)
{
    const auto check = [&](const char* key, std::initializer_list<int> allowed, const char* stand_in)
    {
        const json* value = sampler.find(key);
        if (value == nullptr || std::any_of(allowed.begin(), allowed.end(), [&](int v) { return *value == v; }))
            return;
        warnings.push_back({WarningKind::kMalformed, sampler.at(key),
                            fmt::format("{} {} does not exist", key, shown(*value)), stand_in});
        sampler.object.erase(key);
    };
    check("magFilter", {9728, 9729}, "it is linear");
    check("minFilter", {9728, 9729, 9984, 9985, 9986, 9987}, "it is linear");
    check("wrapS", {10497, 33071, 33648}, "the texture repeats");
    check("wrapT", {10497, 33071, 33648}, "the texture repeats");
}

void repairTransform(const JsonPlace& node, Warnings& warnings)
{
    repairNumbers(node, "translation", 3, "the node is not moved", warnings);
    repairNumbers(node, "scale", 3, "the node is not scaled", warnings);
    repairNumbers(node, "matrix", 16, "the node is not moved, or by its other properties", warnings);
    if (!repairNumbers(node, "rotation", 4, "the node is not turned", warnings))
        return;
    constexpr double kRounding = 0.01; // of 16-bit quaternions, and then some
    double square = 0;
    for (const json& v : node.object["rotation"])
        square += v.get<double>() * v.get<double>();
    if (!(std::abs(std::sqrt(square) - 1) > kRounding))
        return;
    warnings.push_back({WarningKind::kOutOfRange, node.at("rotation"), "rotation is no unit quaternion",
                        square > 0 ? "its direction counts" : "the node is not turned"});
}
