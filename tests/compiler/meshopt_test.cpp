#include "compiler/gltf_meshopt.h"
#include "tests/compiler/gltf_builder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <random>

namespace
{
using Bytes = std::vector<unsigned char>;

Bytes encodeVertices(const void* data, size_t count, size_t stride)
{
    Bytes out(meshopt_encodeVertexBufferBound(count, stride));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), data, count, stride));
    return out;
}

Bytes encodeTriangles(const std::vector<uint32_t>& indices, size_t vertex_count)
{
    Bytes out(meshopt_encodeIndexBufferBound(indices.size(), vertex_count));
    out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
    return out;
}

Bytes encodeSequence(const std::vector<uint32_t>& indices, size_t vertex_count)
{
    Bytes out(meshopt_encodeIndexSequenceBound(indices.size(), vertex_count));
    out.resize(meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), indices.size()));
    return out;
}

/// A file whose compressed streams lie in buffer 0 and whose views stand in buffer 1, which has no data.
class CompressedFile
{
public:
    GltfBuilder builder;
    const char* extension = "EXT_meshopt_compression";

    /// Appends a buffer view of `count` elements that `stream` holds. @return its index
    int view(const Bytes& stream, const char* mode, size_t count, size_t stride, const char* filter = nullptr)
    {
        const int plain = builder.view(stream.data(), stream.size());
        nlohmann::json& view = builder.json["bufferViews"][size_t(plain)];
        nlohmann::json compressed = view;
        compressed.update({{"mode", mode}, {"count", count}, {"byteStride", stride}});
        if (filter != nullptr)
            compressed["filter"] = filter;
        view = {{"buffer", 1},
                {"byteOffset", uncompressed_bytes_},
                {"byteLength", count * stride},
                {"extensions", {{extension, compressed}}}};
        if (std::string(mode) == "ATTRIBUTES")
            view["byteStride"] = stride;
        uncompressed_bytes_ += (count * stride + 3) / 4 * 4;
        builder.json["buffers"] = {
            nlohmann::json::object(),
            {{"byteLength", uncompressed_bytes_}, {"extensions", {{extension, {{"fallback", true}}}}}}};
        return plain;
    }

    nlohmann::json& stream(int view) { return builder.json["bufferViews"][size_t(view)]["extensions"][extension]; }

private:
    size_t uncompressed_bytes_ = 0;
};

/// A bumpy grid of n x n vertices, fewer than 65536.
struct Grid
{
    std::vector<float> positions;
    std::vector<float> normals; // 4 a vertex, w 0
    std::vector<uint32_t> indices;
    size_t count = 0;

    explicit Grid(uint32_t n) : count(n * n)
    {
        for (uint32_t i = 0; i < n * n; ++i)
        {
            const auto x = float(i % n);
            const auto y = float(i / n);
            const float slope = 0.5f * std::cos(x);
            const float length = std::sqrt(1 + slope * slope);
            positions.insert(positions.end(), {x, y, 0.5f * std::sin(x)});
            normals.insert(normals.end(), {-slope / length, 0, 1 / length, 0});
        }
        for (uint32_t y = 0; y + 1 < n; ++y)
            for (uint32_t x = 0; x + 1 < n; ++x)
            {
                const uint32_t v = y * n + x;
                indices.insert(indices.end(), {v, v + 1, v + n, v + n, v + 1, v + n + 1});
            }
        meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), count);
    }
};

/// The grid's positions and triangles, compressed, on a node.
CompressedFile gridFile(const Grid& grid, const char* mode, size_t index_bytes,
                        const char* extension = "EXT_meshopt_compression")
{
    CompressedFile file;
    file.extension = extension;
    const int vertices = file.view(encodeVertices(grid.positions.data(), grid.count, 12), "ATTRIBUTES", grid.count, 12);
    const bool triangles = std::string(mode) == "TRIANGLES";
    const Bytes stream =
        triangles ? encodeTriangles(grid.indices, grid.count) : encodeSequence(grid.indices, grid.count);
    const int indices = file.view(stream, mode, grid.indices.size(), index_bytes);
    const int position = file.builder.accessorOf(vertices, 0, "VEC3", 5126, grid.count);
    const int index =
        file.builder.accessorOf(indices, 0, "SCALAR", index_bytes == 2 ? 5123 : 5125, grid.indices.size());
    file.builder.node({{"mesh", file.builder.mesh({{"attributes", {{"POSITION", position}}}, {"indices", index}})}});
    file.builder.json["extensionsUsed"] = {extension};
    file.builder.json["extensionsRequired"] = {extension};
    return file;
}

void expectGrid(const Result<ImportedScene>& scene, const Grid& grid, const std::string& what)
{
    ASSERT_TRUE(scene) << what << ": " << scene.error().message;
    ASSERT_EQ(scene->primitives.size(), 1u) << what;
    const MeshPrimitive& mesh = scene->primitives[0];
    ASSERT_EQ(mesh.triangles.size(), grid.indices.size() / 3) << what;
    // The triangle codec may turn a triangle's corners; each is compared from its smallest on.
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        std::array<std::array<float, 3>, 3> got;
        std::array<std::array<float, 3>, 3> want;
        for (size_t c = 0; c < 3; ++c)
        {
            const gpu::vec3 p = mesh.positions[(&mesh.triangles[t].x)[c]];
            got[c] = {p.x, p.y, p.z};
            std::copy_n(&grid.positions[3 * grid.indices[3 * t + c]], 3, want[c].begin());
        }
        std::rotate(got.begin(), std::min_element(got.begin(), got.end()), got.end());
        std::rotate(want.begin(), std::min_element(want.begin(), want.end()), want.end());
        ASSERT_EQ(got, want) << what << ", triangle " << t;
    }
}

TEST(Meshopt, EveryModeAndIndexSizeGivesTheMeshThatWasEncoded)
{
    for (const uint32_t side : {3u, 40u}) // less than a block of vertices, and several
    {
        const Grid grid(side);
        for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
            for (const char* mode : {"TRIANGLES", "INDICES"})
                for (const size_t bytes : {2u, 4u})
                    expectGrid(gridFile(grid, mode, bytes, extension).builder.import(), grid,
                               fmt::format("{} {} of {} bytes", extension, mode, bytes));
    }
}

TEST(Meshopt, BinaryFilesAreReadAlike)
{
    const Grid grid(20);
    const TemporaryFolder folder;
    gridFile(grid, "TRIANGLES", 2).builder.writeGlb(folder / "grid.glb");
    const Result<GltfFile> file = readGltf(folder / "grid.glb");
    ASSERT_TRUE(file) << file.error().message;
    expectGrid(importScene(*file), grid, "glb");
}

TEST(Meshopt, OctahedralFilterGivesUnitVectorsWithinItsRounding)
{
    const Grid grid(20);
    for (const size_t stride : {4u, 8u})
    {
        const int bits = stride == 4 ? 8 : 16;
        Bytes filtered(grid.count * stride);
        meshopt_encodeFilterOct(filtered.data(), grid.count, stride, bits, grid.normals.data());
        CompressedFile file = gridFile(grid, "TRIANGLES", 2);
        const int view = file.view(encodeVertices(filtered.data(), grid.count, stride), "ATTRIBUTES", grid.count,
                                   stride, "OCTAHEDRAL");
        file.builder.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
            file.builder.accessorOf(view, 0, "VEC3", stride == 4 ? 5120 : 5122, grid.count, true);
        const Result<ImportedScene> scene = file.builder.import();
        ASSERT_TRUE(scene) << scene.error().message;
        // Half a step in each of two coordinates, which unfolding stretches by 3 at most, then half a step once more.
        const double tolerance = (3 * std::sqrt(2.0) + std::sqrt(3.0)) * 0.5 / ((1 << (bits - 1)) - 1);
        for (size_t v = 0; v < grid.count; ++v)
        {
            const gpu::vec3 n = scene->primitives[0].normals[v];
            EXPECT_NEAR(
                std::hypot(n.x - grid.normals[4 * v], n.y - grid.normals[4 * v + 1], n.z - grid.normals[4 * v + 2]), 0,
                tolerance)
                << stride << " bytes, vertex " << v;
        }
    }
}

TEST(Meshopt, ExponentialFilterKeepsTheMantissaAsked)
{
    const Grid grid(20);
    constexpr int kBits = 15; // of the largest component, sign included
    Bytes filtered(grid.count * 12);
    meshopt_encodeFilterExp(filtered.data(), grid.count, 12, kBits, grid.positions.data());
    CompressedFile file = gridFile(grid, "TRIANGLES", 2);
    const int view =
        file.view(encodeVertices(filtered.data(), grid.count, 12), "ATTRIBUTES", grid.count, 12, "EXPONENTIAL");
    file.builder.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
        file.builder.accessorOf(view, 0, "VEC3", 5126, grid.count);
    const Result<ImportedScene> scene = file.builder.import();
    ASSERT_TRUE(scene) << scene.error().message;
    for (size_t v = 0; v < grid.count; ++v)
    {
        const float* want = &grid.positions[3 * v];
        const float largest = std::max({std::fabs(want[0]), std::fabs(want[1]), std::fabs(want[2])});
        const float step = std::ldexp(2 * largest, 1 - kBits);
        EXPECT_NEAR(scene->primitives[0].positions[v].x, want[0], step);
        EXPECT_NEAR(scene->primitives[0].positions[v].y, want[1], step);
        EXPECT_NEAR(scene->primitives[0].positions[v].z, want[2], step);
    }
}

TEST(Meshopt, QuaternionFilterTurnsInstances)
{
    CompressedFile file = gridFile(Grid(3), "TRIANGLES", 2);
    const float h = std::sqrt(0.5f);
    const std::vector<float> rotations{0, 0, 0, 1, 0, 0, h, h, h, 0, 0, h, 0.5f, -0.5f, 0.5f, 0.5f, 0, 1, 0, 0};
    constexpr size_t kCount = 5;
    Bytes filtered(kCount * 8);
    meshopt_encodeFilterQuat(filtered.data(), kCount, 8, 16, rotations.data());
    const int view = file.view(encodeVertices(filtered.data(), kCount, 8), "ATTRIBUTES", kCount, 8, "QUATERNION");
    file.builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] =
        file.builder.accessorOf(view, 0, "VEC4", 5122, kCount, true);
    const Result<ImportedScene> scene = file.builder.import();
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->instances.size(), kCount);
    for (size_t i = 0; i < kCount; ++i)
    {
        const float* q = &rotations[4 * i];
        const Vec3d u{q[0], q[1], q[2]};
        const Vec3d x{1, 0, 0};
        const Vec3d want = x + (cross(u, cross(u, x)) + cross(u, x) * q[3]) * 2;
        const Vec3d got = scene->instances[i].to_world.vector(x);
        EXPECT_NEAR(length(got - want), 0, 2e-4) << i; // a few steps of 16 bits
    }
}

TEST(Meshopt, UncompressedBuffersStandInForWhatCannotBeDecoded)
{
    const Grid grid(20);
    for (const bool decodable : {true, false})
        for (const bool file_is_there : {true, false})
        {
            CompressedFile file;
            file.extension = "KHR_meshopt_compression";
            file = gridFile(grid, "TRIANGLES", 4, "KHR_meshopt_compression");
            if (!decodable)
                for (const int view : {0, 1})
                {
                    file.stream(view)["mode"] = "ATTRIBUTES";
                    file.stream(view)["filter"] = "COLOR";
                    const size_t bytes = file.builder.json["bufferViews"][size_t(view)]["byteLength"];
                    file.stream(view)["byteStride"] = 4;
                    file.stream(view)["count"] = bytes / 4;
                    file.stream(view)["byteOffset"] = file.stream(0)["byteOffset"];
                    file.stream(view)["byteLength"] = file.stream(0)["byteLength"];
                }
            file.builder.json["buffers"][1]["uri"] = "plain.bin";
            Bytes plain(grid.positions.size() * 4 + grid.indices.size() * 4);
            std::copy_n(reinterpret_cast<const unsigned char*>(grid.positions.data()), grid.positions.size() * 4,
                        plain.begin());
            std::copy_n(reinterpret_cast<const unsigned char*>(grid.indices.data()), grid.indices.size() * 4,
                        plain.begin() + ptrdiff_t(grid.positions.size() * 4));
            const TemporaryFolder folder;
            if (file_is_there)
                writeBytes(folder / "plain.bin", plain.data(), plain.size());
            const Result<GltfFile> read = file.builder.read(folder);
            const std::string what = fmt::format("decodable {}, file {}", decodable, file_is_there);
            if (!decodable && !file_is_there)
            {
                ASSERT_TRUE(read) << what << ": " << read.error().message;
                EXPECT_EQ(strictCode(importScene(*read)), ExitCode::kIo) << what;
                continue;
            }
            ASSERT_TRUE(read) << what << ": " << read.error().message;
            expectGrid(importScene(*read), grid, what);
        }
}

TEST(Meshopt, ANewerCodecOrFilterIsUnsupportedAndSaysSo)
{
    const Grid grid(3);
    for (const bool filter : {false, true})
    {
        CompressedFile file = gridFile(grid, "TRIANGLES", 2, "KHR_meshopt_compression");
        Bytes stream = encodeVertices(grid.positions.data(), grid.count, 4);
        if (!filter)
            stream[0] = 0xa1;
        file.view(stream, "ATTRIBUTES", grid.count, 4, filter ? "COLOR" : "NONE");
        const Result<ImportedScene> scene = file.builder.import();
        ASSERT_FALSE(scene);
        EXPECT_EQ(scene.error().code, ExitCode::kUnsupported);
        EXPECT_NE(scene.error().message.find("EXT_meshopt_compression"), std::string::npos) << scene.error().message;
    }
}

TEST(Meshopt, WrongDescriptionsAreReported)
{
    const Grid grid(20);
    const auto outcome = [&](int view, const char* key, const nlohmann::json& value)
    {
        CompressedFile file = gridFile(grid, "TRIANGLES", 2);
        if (value.is_null())
            file.stream(view).erase(key);
        else
            file.stream(view)[key] = value;
        return strictCode(file.builder.import());
    };
    EXPECT_EQ(outcome(0, "mode", "ATTRIBUTES"), ExitCode::kOk);
    for (const int view : {0, 1})
    {
        for (const char* key : {"buffer", "byteLength", "byteStride", "count", "mode"})
            EXPECT_EQ(outcome(view, key, nullptr), ExitCode::kInvalid) << key;
        for (const char* key : {"buffer", "byteOffset", "byteLength", "byteStride", "count"})
            for (const nlohmann::json& value :
                 std::vector<nlohmann::json>{-1, "2", 1.5, 0xffffffffffffffffull, 1000000})
                EXPECT_EQ(outcome(view, key, value), ExitCode::kInvalid) << key << " " << value;
        EXPECT_EQ(outcome(view, "mode", "SPIRALS"), ExitCode::kInvalid);
        EXPECT_EQ(outcome(view, "filter", "SEPIA"), ExitCode::kInvalid);
    }
    EXPECT_EQ(outcome(0, "filter", "QUATERNION"), ExitCode::kInvalid); // its stride is 8
    EXPECT_EQ(outcome(1, "filter", "EXPONENTIAL"), ExitCode::kInvalid);
    EXPECT_EQ(outcome(0, "mode", "TRIANGLES"), ExitCode::kInvalid);
    EXPECT_EQ(outcome(1, "mode", "INDICES"), ExitCode::kInvalid);
}

TEST(Meshopt, DamagedStreamsAreRefusedOrGiveAnotherMesh)
{
    const Grid grid(20);
    std::mt19937 random(1);
    size_t refused = 0;
    for (const char* mode : {"TRIANGLES", "INDICES"})
    {
        const CompressedFile good = gridFile(grid, mode, 2);
        const TemporaryFolder folder;
        good.builder.writeGlb(folder / "good.glb");
        const Bytes bytes = *readFile(folder / "good.glb");
        const size_t bin =
            bytes.size() -
            good.builder.json["bufferViews"][1]["extensions"][good.extension]["byteOffset"].get<size_t>();
        for (int trial = 0; trial < 40; ++trial)
        {
            Bytes damaged = bytes;
            for (int k = 0; k < 1 + trial % 4; ++k)
                damaged[damaged.size() - 1 - random() % bin] = static_cast<unsigned char>(random());
            writeBytes(folder / "damaged.glb", damaged.data(), damaged.size());
            const Result<GltfFile> file = readGltf(folder / "damaged.glb");
            const Result<ImportedScene> scene = file ? importScene(*file) : Result<ImportedScene>(file.error());
            const ExitCode code = strictCode(scene);
            if (code == ExitCode::kOk)
                continue;
            EXPECT_EQ(code, ExitCode::kInvalid);
            ++refused;
        }
    }
    EXPECT_GT(refused, 4u);
}

TEST(Meshopt, SmallFilesCannotAskForMuchMemory)
{
    const Bytes stream(64, 0);
    for (const auto mode : {MeshoptMode::kAttributes, MeshoptMode::kTriangles, MeshoptMode::kIndices})
    {
        Bytes header = stream;
        header[0] = mode == MeshoptMode::kAttributes ? 0xa0 : mode == MeshoptMode::kTriangles ? 0xe1 : 0xd1;
        const MeshoptView view{.bytes = 64, .count = 3 << 20, .stride = 4, .mode = mode};
        const auto decoded = decodeMeshopt(view, header);
        ASSERT_FALSE(decoded);
        EXPECT_EQ(decoded.error().code, ExitCode::kInvalid);
        EXPECT_NE(decoded.error().message.find("cannot lie in 64 bytes"), std::string::npos) << decoded.error().message;
    }
    // Many views of one stream that compresses well: 1024 equal vertices.
    const std::vector<float> zeros(1024);
    CompressedFile file;
    const Bytes zeros_stream = encodeVertices(zeros.data(), zeros.size(), 4);
    const int first = file.view(zeros_stream, "ATTRIBUTES", zeros.size(), 4);
    const nlohmann::json copy = file.builder.json["bufferViews"][size_t(first)];
    for (int i = 0; i < 100; ++i)
        file.builder.json["bufferViews"].push_back(copy);
    file.builder.triangle();
    const TemporaryFolder folder;
    const Result<GltfFile> read = file.builder.read(folder);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(strictCode(importScene(*read)), ExitCode::kInvalid);
    size_t bytes = 0;
    for (const tinygltf::Buffer& buffer : read->model.buffers)
        bytes += buffer.data.size();
    EXPECT_LE(bytes, (kMeshoptMostRatio + 1) * (zeros_stream.size() + 4096));
}
} // namespace
