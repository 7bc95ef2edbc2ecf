#include "compiler/compile.h"
#include "compiler/parallel.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace
{
using Bytes = std::vector<uint8_t>;

std::string bytesOf(const std::filesystem::path& path)
{
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

ContentHash key(int number)
{
    return Hasher("test").values(number).finish();
}

Bytes made(size_t size, uint8_t first)
{
    Bytes bytes(size);
    for (size_t i = 0; i < size; ++i)
        bytes[i] = uint8_t(first + i);
    return bytes;
}

struct CacheFolder : testing::Test
{
    TemporaryFolder folder;
    Cache cache = std::move(*Cache::open(folder / "cache"));

    std::filesystem::path file() const { return std::filesystem::directory_iterator(folder / "cache")->path(); }
    bool holds(int number) const { return cache.find(key(number)).has_value(); }
};

TEST_F(CacheFolder, AResultIsMadeOnceAndFoundAfterwards)
{
    int calls = 0;
    const auto make = [&] { return ++calls, made(1000, 3); };
    EXPECT_EQ(cache.through(key(1), make), made(1000, 3));
    EXPECT_EQ(cache.through(key(1), make), made(1000, 3));
    EXPECT_EQ(calls, 1);
    EXPECT_EQ(cache.hits(), 1u);
    EXPECT_EQ(cache.misses(), 1u);
    cache.through(key(2), make);
    EXPECT_EQ(calls, 2);
}

TEST_F(CacheFolder, FilesThatAreDamagedCutOrOfAnotherKeyAreMadeAgain)
{
    const auto make = [] { return made(1000, 3); };
    cache.through(key(1), make);
    const std::string whole = bytesOf(file());
    for (size_t i = 0; i < whole.size(); i += 7) // each byte of the header's fields is hit by some step
    {
        std::string damaged = whole;
        damaged[i] = char(damaged[i] ^ 0x40);
        writeBytes(file(), damaged.data(), damaged.size());
        EXPECT_FALSE(holds(1)) << i;
    }
    for (const size_t size : {size_t(0), size_t(20), whole.size() - 1})
    {
        writeBytes(file(), whole.data(), size);
        EXPECT_FALSE(holds(1)) << size;
    }
    writeBytes(file(), whole.data(), whole.size());
    ASSERT_TRUE(holds(1));
    std::filesystem::rename(file(), folder / "cache" / (key(2).hex() + ".lumicache"));
    EXPECT_FALSE(holds(2));
    EXPECT_EQ(cache.through(key(2), [] { return made(10, 5); }), made(10, 5));
    EXPECT_TRUE(holds(2));
}

TEST_F(CacheFolder, TrimmingRemovesWhatWasNotUsedForLongest)
{
    using namespace std::chrono;
    for (const int number : {1, 2, 3})
        cache.through(key(number), [] { return made(1000, 0); });
    const auto now = std::filesystem::file_time_type::clock::now();
    for (const int number : {1, 2, 3})
        std::filesystem::last_write_time(folder / "cache" / (key(number).hex() + ".lumicache"),
                                         now - hours(10 - number));
    EXPECT_TRUE(holds(1)); // used just now
    cache.trim(2500);      // two fit
    EXPECT_TRUE(holds(1));
    EXPECT_FALSE(holds(2));
    EXPECT_TRUE(holds(3));
    cache.trim(0);
    EXPECT_TRUE(std::filesystem::is_empty(folder / "cache"));
}

TEST_F(CacheFolder, WritersAndReadersOfOneKeyDoNotDisturbEachOther)
{
    thread_limit = 8;
    std::atomic<int> wrong = 0;
    parallelFor(400,
                [&](size_t i)
                {
                    if (i % 2 == 0)
                    {
                        const Bytes bytes = made(5000, 9);
                        const std::span<const std::byte> part = std::as_bytes(std::span(bytes));
                        cache.store(key(1), {&part, 1});
                    }
                    else if (const auto found = cache.find(key(1)))
                        wrong += found->size() != 5000 || (*found)[100] != std::byte(109);
                });
    EXPECT_EQ(wrong, 0);
    EXPECT_TRUE(holds(1));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "cache"), {}), 1); // no temporary file is left
}

/// Two textures and a mesh; `corner` moves a vertex, `red` changes one texture.
GltfBuilder scene(float corner, uint8_t red)
{
    GltfBuilder builder;
    const int a = builder.texture(2, 2, {red, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 9, 9, 255});
    const int b = builder.texture(1, 1, {7, 7, 7, 255});
    builder.material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", a}}}}}});
    builder.material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", b}}}}}});
    builder.triangle(
        {{"material", 0}, {"attributes", {{"POSITION", builder.positions({0, 0, 0, 1, 0, 0, 0, corner, 0})}}}});
    builder.triangle({{"material", 1}});
    builder.json["nodes"][1]["translation"] = {0, 0, 2};
    builder.json["scenes"][0]["nodes"] = {0, 1};
    return builder;
}

TEST_F(CacheFolder, OnlyWhatChangedIsMadeAgainAndTheBytesAreTheSame)
{
    const auto compileWith = [&](const GltfBuilder& builder, const Cache* with)
    {
        builder.writeGlb(folder / "scene.glb");
        CompileOptions options{.input = folder / "scene.glb", .output = folder / "scene.lumi"};
        options.cache = with;
        const Result<CompileReport> report = compile(options);
        EXPECT_TRUE(report);
        return std::pair(report->cache_misses, bytesOf(options.output));
    };
    const auto missesIn = [&](const GltfBuilder& builder)
    {
        const Cache fresh_counts = std::move(*Cache::open(folder / "cache"));
        const auto [misses, bytes] = compileWith(builder, &fresh_counts);
        EXPECT_EQ(bytes, compileWith(builder, nullptr).second);
        return misses;
    };
    EXPECT_EQ(missesIn(scene(1, 50)), 3u); // hierarchy, two textures
    EXPECT_EQ(missesIn(scene(1, 50)), 0u);
    EXPECT_EQ(missesIn(scene(1, 60)), 1u); // one texture
    EXPECT_EQ(missesIn(scene(2, 60)), 1u); // hierarchy
    EXPECT_EQ(missesIn(scene(1, 50)), 0u);
}

TEST(Threads, AnyNumberOfThemGivesTheSameBytes)
{
    // Long thin triangles that are worth splitting, heaps of coincident ones, and a grid: everything that a builder
    // could decide by the order in which threads come by.
    std::vector<float> xyz;
    const auto add = [&](std::initializer_list<float> corners) { xyz.insert(xyz.end(), corners); };
    for (int i = 0; i < 3000; ++i)
    {
        const float x = float(i % 50), z = float(i / 50);
        add({x, 0, z, x + 1, 0, z, x, 0, z + 1});
        add({0, float(i % 7), z, 50, float(i % 5) + 1, z + 3, 50, float(i % 5) + 1.01f, z});
        const float shift = 1e-4f * float(i % 3); // equal centres but for three groups
        add({20 + shift, 3, 20, 21 + shift, 3, 20, 20 + shift, 3, 21 + 1e-5f * float(i)});
    }
    GltfBuilder builder;
    builder.json["nodes"] = {{{"mesh", 0}}};
    builder.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", builder.positions(xyz)}}}}}}}};
    const TemporaryFolder folder;
    builder.writeGlb(folder / "scene.glb");
    std::string first;
    for (const unsigned threads : {1u, 2u, 3u, 8u})
    {
        thread_limit = threads;
        const Result<CompileReport> report =
            compile({.input = folder / "scene.glb", .output = folder / "scene.lumi", .zstd_level = 1});
        ASSERT_TRUE(report) << report.error().message;
        const std::string bytes = bytesOf(folder / "scene.lumi");
        if (first.empty())
            first = bytes;
        EXPECT_EQ(first, bytes) << threads;
    }
}
} // namespace
