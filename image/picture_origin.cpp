#include "image/picture_origin.h"

#include <fmt/format.h>

#include <map>
#include <sstream>

namespace
{
std::map<std::string, std::string> linesOf(const std::string& settings)
{
    std::map<std::string, std::string> lines;
    std::istringstream stream(settings);
    for (std::string line; std::getline(stream, line);)
        lines[line.substr(0, line.find(' '))] =
            line.find(' ') == std::string::npos ? "" : line.substr(line.find(' ') + 1);
    return lines;
}

/// "seed 3, not 4; exposure 1, not 0"
std::string settingsDifference(const std::string& is, const std::string& wanted)
{
    constexpr size_t kMost = 3;
    auto have = linesOf(is), want = linesOf(wanted);
    for (const auto& [name, value] : have)
        want.try_emplace(name); // of another version
    std::vector<std::string> differing;
    const auto shown = [](const std::string& value) { return value.empty() ? std::string("none") : value; };
    for (const auto& [name, value] : want)
        if (have[name] != value)
            differing.push_back(fmt::format("{} {}, not {}", name, shown(have[name]), shown(value)));
    if (differing.size() > kMost)
    {
        const size_t more = differing.size() - kMost;
        differing.resize(kMost);
        differing.push_back(fmt::format("and {} more", more));
    }
    std::string text;
    for (const std::string& part : differing)
        text += (text.empty() ? "" : "; ") + part;
    return text;
}
/// ffmpeg 5 loses its way in a header with texts of more than 255 bytes.
constexpr size_t kPieceBytes = 200;

std::string settingsPiece(size_t index)
{
    return fmt::format("{}settings{}", kNotePrefix, index == 0 ? "" : fmt::format(".{}", index));
}
} // namespace

std::vector<PictureNote> originNotes(const PictureOrigin& origin)
{
    std::vector<PictureNote> notes{{std::string(kNotePrefix) + "package", origin.package},
                                   {std::string(kNotePrefix) + "version", origin.version},
                                   {std::string(kNotePrefix) + "device", origin.device}};
    for (size_t at = 0; at < origin.settings.size(); at += kPieceBytes)
        notes.push_back({settingsPiece(at / kPieceBytes), origin.settings.substr(at, kPieceBytes)});
    if (!origin.samples.empty())
        notes.push_back({std::string(kNotePrefix) + "samples", origin.samples});
    return notes;
}

Result<PictureOrigin> readOrigin(const std::filesystem::path& path)
{
    const auto notes = readPictureNotes(path);
    if (!notes)
        return notes.error();
    const auto note = [&](const char* name) { return noteOf(*notes, std::string(kNotePrefix) + name); };
    std::string settings;
    for (size_t piece = 0; !noteOf(*notes, settingsPiece(piece)).empty(); ++piece)
        settings += noteOf(*notes, settingsPiece(piece));
    return PictureOrigin{.package = note("package"),
                         .version = note("version"),
                         .settings = settings,
                         .samples = note("samples"),
                         .device = note("device")};
}

std::string difference(const PictureOrigin& is, const PictureOrigin& wanted)
{
    if (is.package.empty() || is.version.empty())
        return "by another program, or a version that did not say how";
    if (is.package != wanted.package)
        return fmt::format("from another package ({}, not {})", is.package, wanted.package);
    if (is.version != wanted.version)
        return fmt::format("by another version ({}, not {})", is.version, wanted.version);
    if (is.settings != wanted.settings)
        return fmt::format("with other settings ({})", settingsDifference(is.settings, wanted.settings));
    return "";
}
