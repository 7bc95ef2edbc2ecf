// Checks single values of a glTF file's JSON; see gltf_repair.h.
#pragma once
#include "compiler/warnings.h"

#include <nlohmann/json.hpp>

/// One object of the file and where it is.
struct JsonPlace
{
    nlohmann::json& object;
    std::string pointer;

    nlohmann::json* find(const char* key) const;
    std::string at(std::string_view key) const; // pointer to a member, escaped
};

/// Removes a member that is no number (then its default counts) and moves one outside [low, high] to the nearest end.
/// @return whether there is a number now
bool repairNumber(const JsonPlace& place, const char* key, double low, double high, Warnings& warnings);

/// Removes a member that is no array of `length` numbers. @return whether there is one now
bool repairNumbers(const JsonPlace& place, const char* key, size_t length, const char* stand_in, Warnings& warnings);

/// Cameras: @return false where nothing is left of it. Angles above pi are taken as degrees.
bool repairCamera(const JsonPlace& camera, Warnings& warnings);
/// Lights of KHR_lights_punctual: @return false where nothing is left of it.
bool repairLight(const JsonPlace& light, Warnings& warnings);
/// Factors of a material and its extensions; textures are not looked at.
void repairMaterialValues(const JsonPlace& material, Warnings& warnings);
void repairSampler(const JsonPlace& sampler, Warnings& warnings);
/// Translation, rotation, scale, matrix.
void repairTransform(const JsonPlace& node, Warnings& warnings);
