// What a picture says of how it was made: short texts in the header of its file.
#pragma once
#include "format/result.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

/// In an .exr a text attribute, in a .png a text chunk. Names begin with kNotePrefix.
struct PictureNote
{
    std::string name, value;
    bool operator==(const PictureNote&) const = default;
};

inline constexpr const char* kNotePrefix = "lumicut.";

/// The notes of a whole OpenEXR or PNG file (by its extension), in the file's order.
/// @return kIo where it cannot be opened, kInvalid where it is no such picture
Result<std::vector<PictureNote>> readPictureNotes(const std::filesystem::path& path);

/// @return the note's value, "" where there is none
std::string noteOf(std::span<const PictureNote> notes, const std::string& name);
