#include "compiler/warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>

bool isDamage(WarningKind kind)
{
    return kind >= WarningKind::kDanglingIndex;
}

std::string_view kindName(WarningKind kind)
{
    switch (kind)
    {
    case WarningKind::kNote:
        return "note";
    case WarningKind::kApproximated:
        return "approximated";
    case WarningKind::kLeftOut:
        return "left-out";
    case WarningKind::kDefaultLight:
        return "default-light";
    case WarningKind::kDanglingIndex:
        return "dangling-index";
    case WarningKind::kOutOfRange:
        return "out-of-range";
    case WarningKind::kMalformed:
        return "malformed";
    case WarningKind::kUnreadable:
        return "unreadable";
    case WarningKind::kBadGeometry:
        return "bad-geometry";
    }
    return "note";
}

Warning warningOf(WarningKind kind, const Error& error, std::string pointer, std::string stand_in)
{
    std::string message = error.message;
    if (const size_t place = message.rfind(" (/"); place != std::string::npos && message.ends_with(')'))
    {
        pointer = message.substr(place + 2, message.size() - place - 3);
        message.resize(place);
    }
    return {kind, std::move(pointer), std::move(message), std::move(stand_in), error.code};
}

std::string sentence(const Warning& warning)
{
    std::string text = warning.message;
    if (!warning.stand_in.empty())
        text += "; " + warning.stand_in;
    if (!warning.pointer.empty())
        text += fmt::format(" ({})", warning.pointer);
    return text;
}

std::vector<std::string> sentences(const Warnings& warnings)
{
    constexpr size_t kMostAlone = 3;
    using Group = std::tuple<WarningKind, std::string, std::string>; // kind, stand-in, message if it has no pointer
    const auto groupOf = [](const Warning& w) {
        return Group{w.kind, w.stand_in, w.pointer.empty() ? w.message : std::string()};
    };
    std::map<Group, size_t> counts;
    for (const Warning& warning : warnings)
        ++counts[groupOf(warning)];
    std::vector<std::string> lines;
    for (const Warning& warning : warnings)
    {
        size_t& count = counts[groupOf(warning)];
        if (count == 0) // already in the line of the first of its group
            continue;
        lines.push_back(sentence(warning));
        if (count <= kMostAlone)
            continue;
        lines.back() += fmt::format(" and {} more like it", count - 1);
        count = 0;
    }
    return lines;
}

Warnings damageAmong(const Warnings& warnings)
{
    Warnings damage;
    std::copy_if(warnings.begin(), warnings.end(), std::back_inserter(damage),
                 [](const Warning& warning) { return isDamage(warning.kind); });
    return damage;
}
