// Items of a glTF file that its user can select.
#pragma once
#include "format/result.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

struct ListedItem
{
    std::string name; // empty where the file gives none
    std::string kind; // of a camera or light: as the file says; of the default scene: "default"; else empty
    std::optional<double> duration{}; // of an animation whose file says it, seconds
};

/// A list of the file under its plural name.
struct ListedGroup
{
    std::string name;
    std::vector<ListedItem> items; // as in the file
};

/// Scenes, variants, cameras, animations, skins, lights and materials, in this order, each with its index as place.
/// Reads the file's JSON alone: neither buffers nor images need be there.
/// @return kIo where it cannot be read, kInvalid where it is no glTF, kUnsupported for another version of it
Result<std::vector<ListedGroup>> listGltf(const std::filesystem::path& path);

std::string listText(const std::vector<ListedGroup>& groups);

/// Schema "lumicut-compile-list/1".
std::string listJson(const std::vector<ListedGroup>& groups, const std::filesystem::path& path);
