// Warnings about a scene: items that are damaged, left out or approximated.
#pragma once
#include "format/result.h"

#include <string>
#include <string_view>
#include <vector>

enum class WarningKind
{
    kNote,          // about a choice; nothing of the scene is lost
    kApproximated,  // drawn, but not exactly as the file says
    kLeftOut,       // not drawn: a feature that is not supported, or nothing that has a surface
    kDefaultLight,  // light that the compiler added, or would add
    kDanglingIndex, // damage, from here on: names an item that does not exist
    kOutOfRange,    // a number that its property does not allow
    kMalformed,     // a property that is missing, of the wrong type or of the wrong length
    kUnreadable,    // a file or an image that cannot be read or decoded
    kBadGeometry,   // vertices or indices that cannot be used
};

/// Whether the file is not what it should be: such a warning is an error under --strict.
bool isDamage(WarningKind kind);

/// Stable key for programs: "dangling-index".
std::string_view kindName(WarningKind kind);

struct Warning
{
    std::string message; // what is wrong: a sentence without full stop, without its place
    WarningKind kind = WarningKind::kNote;
    std::string pointer = {};           // JSON pointer into the glTF file; empty where it is about no single item
    std::string stand_in = {};          // what takes the item's place; empty where `message` says it
    ExitCode code = ExitCode::kInvalid; // of the error that this would be

    Warning(std::string text) : message(std::move(text)) {}
    Warning(const char* text) : message(text) {}
    Warning(WarningKind what, std::string where, std::string text, std::string instead,
            ExitCode as_error = ExitCode::kInvalid)
        : message(std::move(text)), kind(what), pointer(std::move(where)), stand_in(std::move(instead)), code(as_error)
    {
    }
};

/// A warning of what would be an error. Where the message ends in a place, " (/nodes/3)", that is the pointer.
Warning warningOf(WarningKind kind, const Error& error, std::string pointer, std::string stand_in);

using Warnings = std::vector<Warning>; // in the order in which they were found

/// "message; stand-in (pointer)".
std::string sentence(const Warning& warning);

/// Text output: more than three warnings of one kind and with one stand-in become the first, "and 12 more like it".
std::vector<std::string> sentences(const Warnings& warnings);

/// Those that are damage.
Warnings damageAmong(const Warnings& warnings);
