// Builds small glTF files in memory and on disk, for the tests.
#pragma once
#include "compiler/import_gltf.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// A folder that goes away with the object.
class TemporaryFolder
{
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

class GltfBuilder
{
public:
    nlohmann::json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};

    /// Appends bytes to the buffer. @return the new buffer view's index
    int view(const void* data, size_t bytes, size_t stride = 0);

    template <typename T>
    int accessor(const std::vector<T>& values, const char* type, int component_type, size_t count,
                 bool normalized = false)
    {
        return accessorOf(view(values.data(), values.size() * sizeof(T)), 0, type, component_type, count, normalized);
    }
    int accessorOf(int view, size_t offset, const char* type, int component_type, size_t count,
                   bool normalized = false);

    int positions(const std::vector<float>& xyz) { return accessor(xyz, "VEC3", 5126, xyz.size() / 3); }

    /// Appends a mesh of one primitive. @return its index
    int mesh(const nlohmann::json& primitive);
    int node(const nlohmann::json& node);
    int material(const nlohmann::json& material);
    /// Appends a texture with a PNG of RGBA texels in the buffer. @return the texture's index
    int texture(uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba);

    /// One triangle (0,0,0) (1,0,0) (0,1,0) on node 0, with `extra` merged into its primitive.
    void triangle(const nlohmann::json& extra = nlohmann::json::object());

    std::string text() const; // .gltf with a data URI
    void writeGltf(const std::filesystem::path& path) const;
    void writeGlb(const std::filesystem::path& path) const;

    /// Reads and imports by way of a file in `folder`.
    Result<GltfFile> read(const TemporaryFolder& folder) const;
    Result<ImportedScene> import() const;
    /// import(), images and world mesh.
    Result<SceneData> scene() const;

private:
    int append(const char* list, const nlohmann::json& item);
    nlohmann::json withBuffer(bool embedded) const;
    std::vector<unsigned char> buffer_;
};

/// The exit code of an import, or under --strict: that of its first damage.
ExitCode strictCode(const Result<ImportedScene>& imported);

std::vector<unsigned char> encodePng(uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba);
void writeBytes(const std::filesystem::path& path, const void* data, size_t bytes);
