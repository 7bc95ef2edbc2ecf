// lumicut-scenes: writes its scenes as binary glTF files. The same program writes the same bytes.
#include "image/write_image.h"
#include "tools/cli/documentation.h"
#include "tools/scenes/scenes.h"

#include <fmt/format.h>

namespace
{

int fail(const std::string& file, const Error& error)
{
    fmt::print(stderr, "{}: error: {}\n", file, error.message);
    return int(error.code);
}

int write(const std::filesystem::path& folder, const std::string& name, const GltfWriter& gltf)
{
    const std::vector<uint8_t> bytes = gltf.glb();
    const std::filesystem::path path = folder / (name + ".glb");
    if (const Status written = writeFile(path, bytes); !written)
        return fail(path.string(), written.error());
    fmt::print("{}: {} triangles, {} bytes\n", path.string(), gltf.triangleCount(), bytes.size());
    return int(ExitCode::kOk);
}

int run(const std::string& folder, const std::vector<std::string>& names, uint32_t terrain_triangles)
{
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem)
        return fail(folder, {ExitCode::kIo, fmt::format("The folder cannot be created: {}.", problem.message())});
    if (terrain_triangles != 0)
        return write(folder, "terrain", terrainScene(terrain_triangles));
    for (const Scene& scene : allScenes())
    {
        if (!names.empty() && std::find(names.begin(), names.end(), scene.name) == names.end())
            continue;
        if (const int code = write(folder, scene.name, scene.build()); code != int(ExitCode::kOk))
            return code;
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
    addDocumentation(app);
    std::vector<std::string> known;
    std::string list = "Scenes:\n";
    for (const Scene& scene : allScenes())
    {
        known.push_back(scene.name);
        list += fmt::format("  {:<17} {}\n", scene.name, scene.about);
    }
    app.footer(list);
    CLI::Option* const some =
        app.add_option("NAME", names, "which scenes, of those below (all)")->check(CLI::IsMember(known));
    uint32_t terrain_triangles = 0;
    app.add_option("--terrain", terrain_triangles,
                   "instead write terrain.glb, a landscape of about this many triangles")
        ->check(CLI::Range(1000, 50'000'000))
        ->excludes(some);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& problem)
    {
        return app.exit(problem) == 0 ? int(ExitCode::kOk) : int(ExitCode::kUsage);
    }
    return run(folder, names, terrain_triangles);
}
