#include "image/picture_notes.h"

#include "format/mapped_file.h"
#include "image/exr_headers.h"
#include "image/png_chunks.h"

#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>

namespace
{
using Bytes = std::span<const std::byte>;

bool isNote(std::string_view name)
{
    return name.starts_with(kNotePrefix);
}

std::vector<PictureNote> notesOfPng(Bytes file)
{
    std::vector<PictureNote> notes;
    forEachPngChunk(file,
                    [&](uint32_t type, Bytes data)
                    {
                        const std::string_view text(reinterpret_cast<const char*>(data.data()), data.size());
                        const size_t end = text.find('\0');
                        if (type == kPngText && end != std::string_view::npos && isNote(text.substr(0, end)))
                            notes.push_back({std::string(text.substr(0, end)), std::string(text.substr(end + 1))});
                        return true;
                    });
    return notes;
}

Result<std::vector<PictureNote>> notesOfExr(Bytes file)
{
    const auto headers = readExrHeaders(file);
    if (!headers)
        return headers.error();
    std::vector<PictureNote> notes;
    const Imf::Header& header = headers->front();
    for (auto i = header.begin(); i != header.end(); ++i)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute()); text && isNote(i.name()))
            notes.push_back({i.name(), text->value()});
    return notes;
}
} // namespace

Result<std::vector<PictureNote>> readPictureNotes(const std::filesystem::path& path)
{
    const auto file = package::MappedFile::open(path);
    if (!file)
        return file.error();
    if (path.extension() == ".png")
        return notesOfPng(file->bytes());
    try
    {
        return notesOfExr(file->bytes());
    }
    catch (const std::exception& problem) // of the library
    {
        return Error{ExitCode::kInvalid, fmt::format("its header cannot be read: {}", problem.what())};
    }
}

std::string noteOf(std::span<const PictureNote> notes, const std::string& name)
{
    const auto note = std::ranges::find(notes, name, &PictureNote::name);
    return note == notes.end() ? "" : note->value;
}
