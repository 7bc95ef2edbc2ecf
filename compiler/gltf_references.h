// The lists of a glTF file and the references between them, as they are repaired; see gltf_repair.h.
#pragma once
#include "compiler/gltf_values.h"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <vector>

inline constexpr const char* kLightList = "extensions/KHR_lights_punctual/lights"; // as a list's name and as its place

/// A number that is an index, however it is written.
std::optional<size_t> indexIn(const nlohmann::json& value);
/// An unsigned number, `fallback` where there is none, nothing where there is something else.
std::optional<uint64_t> sizeIn(const JsonPlace& place, const char* key, uint64_t fallback);

class References
{
public:
    enum class Kind
    {
        kAbsent,
        kGood,
        kBad, // and removed
    };

    References(nlohmann::json& document, Warnings& warnings) : document_(document), warnings_(warnings) {}

    Warnings& warnings() { return warnings_; }
    void warn(WarningKind kind, std::string pointer, std::string message, std::string stand_in);

    /// Makes every list an array of objects.
    void repairLists();
    /// Null where the file has none.
    nlohmann::json* list(std::string_view name);
    /// Removes `extensions` that are no object.
    void dropMalformed(const JsonPlace& item);

    /// Calls repair(place, i) with each item.
    template <typename Function>
    void each(const char* name, const Function& repair)
    {
        nlohmann::json* items = list(name);
        for (size_t i = 0; items != nullptr && i < items->size(); ++i)
        {
            const JsonPlace place{(*items)[i], fmt::format("/{}/{}", name, i)};
            dropMalformed(place);
            repair(place, i);
        }
    }

    /// Those for which `repair` returns false are lost: nothing may refer to them.
    template <typename Function>
    void loseEach(const char* name, const Function& repair)
    {
        std::vector<bool>& lost = lost_[name];
        each(name,
             [&](const JsonPlace& place, size_t)
             {
                 lost.push_back(!repair(place));
                 if (lost.back())
                     place.object = harmless(name);
             });
    }

    /// Whether `value` is the index of an item of a list; adds a warning if it is not. `what` is the item's noun.
    bool names(const nlohmann::json& value, const std::string& pointer, const char* target, const char* what,
               const char* stand_in);
    /// The same of a member, which is an unsigned number afterwards, or gone.
    Kind resolve(const JsonPlace& place, const char* key, const char* target, const char* what, const char* stand_in);

private:
    /// What the reader takes and nothing refers to.
    static nlohmann::json harmless(std::string_view name);

    nlohmann::json& document_;
    Warnings& warnings_;
    std::map<std::string, std::vector<bool>, std::less<>> lost_; // by list: items that nothing may refer to
};
