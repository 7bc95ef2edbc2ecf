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

/// Scenes of a size, in place of those with names; 0: none.
struct Sizes
{
    uint32_t terrain = 0, boxes = 0, swarm = 0, tube = 0;
};

int run(const std::string& folder, const std::vector<std::string>& names, const Sizes& sizes)
{
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem)
        return fail(folder, {ExitCode::kIo, fmt::format("The folder cannot be created: {}.", problem.message())});
    if (sizes.terrain != 0)
        return write(folder, "terrain", terrainScene(sizes.terrain));
    if (sizes.boxes != 0)
        return write(folder, "boxes", boxesScene(sizes.boxes));
    if (sizes.swarm != 0)
        return write(folder, "swarm", swarmScene(sizes.swarm));
    if (sizes.tube != 0)
        return write(folder, "tube", tubeScene(sizes.tube));
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
    Sizes sizes;
    CLI::Option* const terrain = app.add_option("--terrain", sizes.terrain,
                                                "instead write terrain.glb, a landscape of about this many triangles")
                                     ->check(CLI::Range(1000, 50'000'000))
                                     ->excludes(some);
    CLI::Option* const boxes =
        app.add_option("--boxes", sizes.boxes, "instead write boxes.glb, this many boxes that move")
            ->check(CLI::Range(1, 1'000'000))
            ->excludes(some)
            ->excludes(terrain);
    CLI::Option* const swarm =
        app.add_option("--swarm", sizes.swarm, "instead write swarm.glb, this many boxes that change places")
            ->check(CLI::Range(1, 1'000'000))
            ->excludes(some)
            ->excludes(terrain)
            ->excludes(boxes);
    app.add_option("--tube", sizes.tube, "instead write tube.glb, a skinned tube of about this many triangles")
        ->check(CLI::Range(128, 10'000'000))
        ->excludes(some)
        ->excludes(terrain)
        ->excludes(boxes)
        ->excludes(swarm);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& problem)
    {
        return app.exit(problem) == 0 ? int(ExitCode::kOk) : int(ExitCode::kUsage);
    }
    return run(folder, names, sizes);
}
