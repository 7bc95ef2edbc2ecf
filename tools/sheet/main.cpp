// lumicut-sheet: many small PNG pictures in one, numbered by their file names.
#include "format/result.h"
#include "image/write_image.h"
#include "tools/sheet/contact_sheet.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <stb_image.h>

#include <filesystem>
#include <memory>

namespace
{
int fail(const std::string& where, const Error& error)
{
    fmt::print(stderr, "{}: error: {}\n", where, error.message);
    return int(error.code);
}

Result<Thumbnail> readThumbnail(const std::string& path)
{
    int width = 0;
    int height = 0;
    int channels = 0;
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> texels(
        stbi_load(path.c_str(), &width, &height, &channels, 3), &stbi_image_free);
    if (texels == nullptr)
        return std::filesystem::exists(path) ? Error{ExitCode::kInvalid, "it is no PNG picture"}
                                             : Error{ExitCode::kIo, "it does not exist"};
    Thumbnail thumbnail{std::filesystem::path(path).stem().string(), uint32_t(width), uint32_t(height), {}};
    thumbnail.rgb.assign(texels.get(), texels.get() + size_t(3) * thumbnail.width * thumbnail.height);
    return thumbnail;
}
} // namespace

int main(int argc, char** argv)
{
    CLI::App app{"Puts small PNG pictures into one, each under the digits of its file's name.", "lumicut-sheet"};
    app.footer("Exit codes: 0 ok, 1 usage, 2 I/O, 3 a file is no PNG picture.");
    std::vector<std::string> pictures;
    std::string output;
    uint32_t columns = 12;
    app.add_option("pictures", pictures, "Pictures (.png), in their order")->required();
    app.add_option("-o,--output", output, "Picture to write (.png)")->required();
    app.add_option("--columns", columns, "Pictures a row")->check(CLI::Range(1u, 1000u))->capture_default_str();
    app.set_version_flag("--version", "lumicut-sheet " LUMICUT_VERSION);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& e)
    {
        if (e.get_exit_code() == 0)
            return app.exit(e);
        return fail("lumicut-sheet", {ExitCode::kUsage, fmt::format("{} (see --help)", e.what())});
    }
    std::vector<Thumbnail> thumbnails;
    for (const std::string& path : pictures)
    {
        Result<Thumbnail> thumbnail = readThumbnail(path);
        if (!thumbnail)
            return fail(path, thumbnail.error());
        thumbnails.push_back(std::move(*thumbnail));
    }
    const Thumbnail sheet = contactSheet(thumbnails, columns);
    if (const Status status = writePng(output, sheet.width, sheet.height, 3, sheet.rgb); !status)
        return fail(output, status.error());
    return 0;
}
