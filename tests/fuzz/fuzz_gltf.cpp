// Whatever the bytes: importing a .glb ends in an error or in a mesh whose indices lie in it.
#include "compiler/flatten.h"
#include "compiler/images.h"
#include "compiler/import_gltf.h"
#include "format/check.h"

#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace
{
/// The importer reads files only; this one goes with the process.
struct GlbFile
{
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("lumicut-fuzz-" + std::to_string(getpid()) + ".glb");
    ~GlbFile()
    {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
};

void import(const std::filesystem::path& path)
{
    const Result<GltfFile> file = readGltf(path);
    if (!file)
        return;
    Result<ImportedScene> imported = importScene(*file);
    if (!imported)
        return;
    (void)decodeImages(*file, imported->images);
    SceneData& scene = imported->scene;
    const Result<WorldMesh> mesh = flatten(*imported, scene.counts, scene.warnings);
    if (!mesh)
        return;
    for (size_t i = 0; i < mesh->triangles.size(); ++i)
    {
        const gpu::uvec3 t = mesh->triangles[i];
        const size_t count = mesh->positions.size();
        check(t.x < count && t.y < count && t.z < count && mesh->materials[i] < scene.materials.size(), "triangle {}",
              i);
    }
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    static const GlbFile glb;
    std::ofstream(glb.path, std::ios::binary).write(reinterpret_cast<const char*>(data), std::streamsize(size));
    try
    {
        import(glb.path);
    }
    catch (const std::exception&) // of a third-party library: compile() makes a sentence of it
    {
    }
    return 0;
}
