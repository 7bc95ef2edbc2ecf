#include "tests/compiler/gltf_builder.h"

#include "compiler/gltf_material.h"

#include "compiler/flatten.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image_write.h>
#pragma GCC diagnostic pop

#include <cstdlib>
#include <cstring>
#include <fstream>

namespace
{
std::string base64(const std::vector<unsigned char>& bytes)
{
    static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3)
    {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; ++k)
            text.push_back(i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63u] : '=');
    }
    return text;
}
} // namespace

TemporaryFolder::TemporaryFolder()
{
    std::string name = (std::filesystem::temp_directory_path() / "lumicut-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
}

TemporaryFolder::~TemporaryFolder()
{
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

int GltfBuilder::view(const void* data, size_t bytes, size_t stride)
{
    buffer_.resize((buffer_.size() + 3) / 4 * 4);
    nlohmann::json entry = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes}};
    if (stride != 0)
        entry["byteStride"] = stride;
    const auto* from = static_cast<const unsigned char*>(data);
    buffer_.insert(buffer_.end(), from, from + bytes);
    return append("bufferViews", entry);
}

int GltfBuilder::append(const char* list, const nlohmann::json& item)
{
    json[list].push_back(item);
    return int(json[list].size()) - 1;
}

int GltfBuilder::accessorOf(int view, size_t offset, const char* type, int component_type, size_t count,
                            bool normalized)
{
    return append("accessors", {{"bufferView", view},
                                {"byteOffset", offset},
                                {"type", type},
                                {"componentType", component_type},
                                {"count", count},
                                {"normalized", normalized}});
}

int GltfBuilder::mesh(const nlohmann::json& primitive)
{
    return append("meshes", {{"primitives", nlohmann::json::array({primitive})}});
}
int GltfBuilder::node(const nlohmann::json& node)
{
    return append("nodes", node);
}
int GltfBuilder::material(const nlohmann::json& material)
{
    return append("materials", material);
}

int GltfBuilder::texture(uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba)
{
    const std::vector<unsigned char> png = encodePng(width, height, rgba);
    const int image = append("images", {{"bufferView", view(png.data(), png.size())}, {"mimeType", "image/png"}});
    return append("textures", {{"source", image}});
}

void GltfBuilder::triangle(const nlohmann::json& extra)
{
    nlohmann::json primitive = {{"attributes", {{"POSITION", positions({0, 0, 0, 1, 0, 0, 0, 1, 0})}}}};
    primitive.merge_patch(extra);
    node({{"mesh", mesh(primitive)}});
}

nlohmann::json GltfBuilder::withBuffer(bool embedded) const
{
    nlohmann::json document = json;
    if (buffer_.empty())
        return document;
    nlohmann::json& buffer = document["buffers"][0];
    buffer["byteLength"] = buffer_.size();
    if (embedded)
        buffer["uri"] = "data:application/octet-stream;base64," + base64(buffer_);
    return document;
}

std::string GltfBuilder::text() const
{
    return withBuffer(true).dump();
}

void GltfBuilder::writeGltf(const std::filesystem::path& path) const
{
    const std::string gltf = text();
    writeBytes(path, gltf.data(), gltf.size());
}

void GltfBuilder::writeGlb(const std::filesystem::path& path) const
{
    std::string text = withBuffer(false).dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<unsigned char> bin = buffer_;
    bin.resize((bin.size() + 3) / 4 * 4);
    std::string bytes;
    const auto u32 = [&](size_t v)
    {
        const uint32_t value = uint32_t(v);
        bytes.append(reinterpret_cast<const char*>(&value), 4);
    };
    bytes += "glTF";
    u32(2), u32(12 + 8 + text.size() + 8 + bin.size());
    u32(text.size()), u32(0x4E4F534A);
    bytes += text;
    u32(bin.size()), u32(0x004E4942);
    bytes.append(reinterpret_cast<const char*>(bin.data()), bin.size());
    writeBytes(path, bytes.data(), bytes.size());
}

Result<GltfFile> GltfBuilder::read(const TemporaryFolder& folder) const
{
    writeGltf(folder / "scene.gltf");
    return readGltf(folder / "scene.gltf");
}

Result<ImportedScene> GltfBuilder::import() const
{
    const TemporaryFolder folder;
    const Result<GltfFile> file = read(folder);
    if (!file)
        return file.error();
    return importScene(*file);
}

Result<SceneData> GltfBuilder::scene() const
{
    const TemporaryFolder folder;
    const Result<GltfFile> file = read(folder);
    if (!file)
        return file.error();
    Result<ImportedScene> imported = importScene(*file);
    if (!imported)
        return imported.error();
    Result<std::vector<DecodedImage>> images = decodeImages(*file, imported->images);
    if (!images)
        return images.error();
    takeImages(std::move(*images), imported->scene);
    Result<WorldMesh> mesh = flatten(*imported, imported->scene.counts, imported->scene.warnings);
    if (!mesh)
        return mesh.error();
    imported->scene.mesh = std::move(*mesh);
    return std::move(imported->scene);
}

ExitCode strictCode(const Result<ImportedScene>& imported)
{
    if (!imported)
        return imported.error().code;
    const Warnings damage = damageAmong(imported->scene.warnings);
    return damage.empty() ? ExitCode::kOk : damage[0].code;
}

std::vector<unsigned char> encodePng(uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba)
{
    std::vector<unsigned char> png;
    const auto append = [](void* to, void* data, int bytes)
    {
        const auto* from = static_cast<const unsigned char*>(data);
        static_cast<std::vector<unsigned char>*>(to)->insert(static_cast<std::vector<unsigned char>*>(to)->end(), from,
                                                             from + bytes);
    };
    stbi_write_png_to_func(append, &png, int(width), int(height), 4, rgba.data(), int(width * 4));
    return png;
}

void writeBytes(const std::filesystem::path& path, const void* data, size_t bytes)
{
    std::ofstream(path, std::ios::binary).write(static_cast<const char*>(data), std::streamsize(bytes));
}
