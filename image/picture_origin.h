// What a picture was made from and how: pictures that were made in different ways must not be mixed.
#pragma once
#include "image/picture_notes.h"

struct PictureOrigin
{
    std::string package;  // the hash in its header, and by way of it of all of it
    std::string version;  // of the player, with a hash of its kernels and sources
    std::string settings; // a line each, "name value": options and settings that decide what a picture shows
    std::string samples;  // of --samples, "A-B", several with commas; empty: all of the picture
    std::string device;   // with its driver; not compared: a farm may have several kinds
};

std::vector<PictureNote> originNotes(const PictureOrigin& origin);
/// The origin in the header of a whole picture; empty members where it says nothing.
Result<PictureOrigin> readOrigin(const std::filesystem::path& path);

/// What tells `is` from `wanted`, as the end of a sentence ("from another package (...)"); empty: nothing that counts.
std::string difference(const PictureOrigin& is, const PictureOrigin& wanted);
