// What is written is what is read, whatever the options; equal content gives equal bytes.
#include "tests/format/sample_package.h"
#include "tests/format/walk_package.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace
{
template <typename T>
void expectSame(std::span<const T> read, const std::vector<T>& written)
{
    ASSERT_EQ(read.size(), written.size());
    EXPECT_EQ(std::memcmp(read.data(), written.data(), read.size_bytes()), 0);
}

bool same(const gpu::vec3& a, const gpu::vec3& b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/// Triangle i of the sample is entry i of chunk LEAF.
void expectGeometry(const package::Package& package, const SamplePackage& sample)
{
    ASSERT_EQ(package.bvhTriangles().size(), sample.leaf_triangles.size());
    ASSERT_EQ(package.triangles().size(), sample.triangles.size());
    for (uint32_t i = 0; i < sample.triangles.size(); ++i)
    {
        const gpu::BvhTriangle& t = package.bvhTriangles()[i];
        EXPECT_EQ(t.triangle, i);
        EXPECT_EQ(t.material | t.flags << 30, sample.triangles[i].material);
        EXPECT_TRUE(same(t.v0, sample.positions[3 * i]) && same(t.v1, sample.positions[3 * i + 1]) &&
                    same(t.v2, sample.positions[3 * i + 2]))
            << i;
        EXPECT_EQ(package.triangles()[i].vertices.y, 3 * i + 1);
        EXPECT_EQ(package.triangles()[i].light, i == 1 && !sample.lights.empty() ? 1 : gpu::kNone);
    }
    ASSERT_EQ(package.vertexAttributes().size(), sample.vertices.size());
    for (size_t i = 0; i < sample.vertices.size(); ++i)
    {
        const gpu::VertexAttributes& v = package.vertexAttributes()[i];
        EXPECT_EQ(v.normal, sample.vertices[i].normal);
        EXPECT_EQ(v.tangent, sample.vertices[i].tangent);
        EXPECT_EQ(v.uv0.y, sample.vertices[i].uv0.y);
        EXPECT_EQ(v.uv1.y, sample.extras.empty() ? 0 : sample.extras[i].uv1.y);
        EXPECT_EQ(v.color.x, 0x3c003c00u);
    }
}

void expectSample(const package::Package& package, const SamplePackage& sample)
{
    expectGeometry(package, sample);
    expectSame(package.materials(), sample.materials);
    expectSame(package.textureRefs(), sample.texture_refs);
    expectSame(package.lights(), sample.lights);
    expectSame(package.lightAliases(), sample.light_aliases);
    expectSame(package.lightYields(), sample.light_yields);
    expectSame(package.environmentTexels(), sample.environment_texels);
    expectSame(package.environmentMap(), sample.environment_map);
    expectSame(package.causticTargets(), sample.caustic_targets);
    expectSame(package.texturePage(0), sample.texture_pages[0]);
    EXPECT_EQ(package.meta().cameras()->Get(0)->name()->str(), "front");
    EXPECT_EQ(package.meta().provenance()->source()->str(), "sample.gltf");
}
} // namespace

TEST(PackageRoundTrip, EveryChunkComesBackAsWritten)
{
    const SamplePackage sample;
    const std::vector<std::byte> bytes = sample.bytes();
    const auto package = package::Package::openBytes(bytes);
    ASSERT_TRUE(package) << package.error().message;
    expectSample(*package, sample);
    EXPECT_EQ(package->fileBytes(), bytes.size());
    EXPECT_EQ(package->chunks().size(), 16u);
    EXPECT_TRUE(std::isfinite(walkPackage(*package)));
}

TEST(PackageRoundTrip, OriginAndUnitComeBackAndAreZeroAndOneMetreWhereAbsent)
{
    SamplePackage sample;
    const std::vector<std::byte> plain = sample.bytes();
    sample.meta.origin = std::make_unique<lumicut::fb::Vec3d>(2600000.25, 400.0, -1200000.5);
    sample.meta.unit = 0.25;
    const std::vector<std::byte> moved = sample.bytes();
    const auto without = package::Package::openBytes(plain);
    const auto with = package::Package::openBytes(moved);
    ASSERT_TRUE(without && with);
    EXPECT_EQ(without->meta().origin(), nullptr);
    EXPECT_EQ(without->meta().unit(), 1);
    ASSERT_NE(with->meta().origin(), nullptr);
    EXPECT_EQ(with->meta().origin()->x(), 2600000.25);
    EXPECT_EQ(with->meta().origin()->y(), 400);
    EXPECT_EQ(with->meta().origin()->z(), -1200000.5);
    EXPECT_EQ(with->meta().unit(), 0.25);
}

TEST(PackageRoundTrip, CompressedChunksComeBackAsWritten)
{
    SamplePackage sample;
    sample.texture_pages[0].resize(size_t(256) * 256 * 4);
    for (size_t i = 0; i < sample.texture_pages[0].size(); ++i)
        sample.texture_pages[0][i] = std::byte(i * i >> 12 & 15); // shrinks well
    auto& page = *sample.meta.texture_pages[0];
    page.width = page.height = 256;
    page.layers = 1;
    page.levels = 1;
    sample.texture_refs[1].layer = 0;
    sample.texture_refs[0].size = sample.texture_refs[1].size = 256 | 256 << 16;
    const std::vector<std::byte> plain = sample.bytes();
    const std::vector<std::byte> packed = sample.bytes({.zstd_level = 5});
    EXPECT_LT(packed.size(), plain.size() / 4);
    const auto package = package::Package::openBytes(packed);
    ASSERT_TRUE(package) << package.error().message;
    expectSample(*package, sample);
}

TEST(PackageRoundTrip, OptionalChunksMayBeAbsent)
{
    SamplePackage sample;
    sample.lights.clear();
    sample.light_aliases.clear();
    sample.light_yields.clear();
    sample.environment_map.clear();
    sample.environment_texels.clear();
    sample.meta.environment.reset();
    sample.caustic_targets.clear();
    sample.extras.clear();
    sample.texture_refs.clear();
    sample.texture_pages.clear();
    sample.meta.texture_pages.clear();
    sample.materials[1].emissive_texture = gpu::kNone;
    sample.materials[2].base_color_texture = gpu::kNone;
    const std::vector<std::byte> bytes = sample.bytes();
    const auto package = package::Package::openBytes(bytes);
    ASSERT_TRUE(package) << package.error().message;
    expectGeometry(*package, sample);
    EXPECT_TRUE(package->lights().empty());
    EXPECT_TRUE(package->textureRefs().empty());
    EXPECT_EQ(package->chunks().size(), 7u);
}

TEST(PackageRoundTrip, EqualContentGivesEqualBytes)
{
    EXPECT_EQ(SamplePackage().bytes(), SamplePackage().bytes());
    EXPECT_EQ(SamplePackage().bytes({.zstd_level = 3}), SamplePackage().bytes({.zstd_level = 3}));
}

TEST(PackageRoundTrip, UncompressedBulkLiesOnPageBoundaries)
{
    const std::vector<std::byte> bytes = SamplePackage().bytes();
    const auto package = package::Package::openBytes(bytes);
    ASSERT_TRUE(package);
    for (const package::ChunkEntry& entry : package->chunks())
    {
        const uint64_t alignment = entry.id == package::kMetaChunk ? package::kSmallAlignment : package::kBulkAlignment;
        EXPECT_EQ(entry.offset % alignment, 0u) << package::chunkName(entry.id);
    }
}
