// lumicut-scenes: writes its scenes as binary glTF files. The same program writes the same bytes.
#include "image/write_image.h"
#include "tools/scenes/scenes.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace
{

int fail(const std::string& file, const Error& error)
{
    fmt::print(stderr, "{}: error: {}\n", file, error.message);
    return int(error.code);
}

int run(const std::string& folder, const std::vector<std::string>& names)
{
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem)
        return fail(folder, {ExitCode::kIo, fmt::format("The folder cannot be created: {}.", problem.message())});
    for (const Scene& scene : allScenes())
    {
        if (!names.empty() && std::find(names.begin(), names.end(), scene.name) == names.end())
            continue;
        const GltfWriter gltf = scene.build();
        const std::vector<uint8_t> bytes = gltf.glb();
        const std::filesystem::path path = std::filesystem::path(folder) / (std::string(scene.name) + ".glb");
        if (const Status written = writeFile(path, bytes); !written)
            return fail(path.string(), written.error());
        fmt::print("{}: {} triangles, {} bytes\n", path.string(), gltf.triangleCount(), bytes.size());
    }
    return int(ExitCode::kOk);
}

} // namespace

int main(int argc, char** argv)
{
    std::string folder;
    std::vector<std::string> names;
    CLI::App app{"Writes scenes (CC0) as binary glTF files into OUTDIR.\nExit codes: 0 done, 1 usage, 2 a file "
                 "cannot be written.",
                 "lumicut-scenes"};
    app.set_version_flag("--version", "lumicut-scenes " LUMICUT_VERSION);
    app.add_option("OUTDIR", folder, "where to write; made if it is not there")->required();
    std::vector<std::string> known;
    std::string list = "Scenes:\n";
    for (const Scene& scene : allScenes())
    {
        known.push_back(scene.name);
        list += fmt::format("  {:<17} {}\n", scene.name, scene.about);
    }
    app.footer(list);
    app.add_option("NAME", names, "which scenes, of those below (all)")->check(CLI::IsMember(known));
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& problem)
    {
        return app.exit(problem) == 0 ? int(ExitCode::kOk) : int(ExitCode::kUsage);
    }
    return run(folder, names);
}
