// One wrong field each, behind right hashes: the reader must name the chunk and what is wrong.
#include "tests/format/rehash.h"
#include "tests/format/sample_package.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>

namespace
{
/// 2 layers of 4 x 4, 2 x 2 and 1 x 1 texels: a block each of 16 bytes take 96.
void makeBlocks(SamplePackage& s, size_t bytes)
{
    s.meta.texture_pages[0]->encoding = lumicut::fb::TextureEncoding::Bc7Unorm;
    s.texture_pages[0].resize(bytes);
}

/// A page of 32 x 16 texels with two tiles of 4 x 4: with borders and levels 12 x 8. @param x of the second
void makeTiles(SamplePackage& s, uint32_t x)
{
    lumicut::fb::TexturePageT& page = *s.meta.texture_pages[0];
    page.encoding = lumicut::fb::TextureEncoding::Bc4Unorm;
    page.tiled = true;
    page.width = 32, page.height = 16, page.layers = page.levels = 1;
    s.texture_pages[0].resize(8 * 4 * 8);
    s.texture_refs[0].sampling = gpu::kSampleTile;
    s.texture_refs[1].sampling = gpu::kSampleTile | gpu::kSampleUv1;
    s.texture_refs[1].layer = 0;
    s.texture_refs[1].origin = x;
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

struct ContentCase
{
    const char* name;
    const char* words; // that the message must hold
    std::function<void(SamplePackage&)> spoil;
};
void PrintTo(const ContentCase& c, std::ostream* out)
{
    *out << c.name;
}

// clang-format off
const ContentCase kContentCases[] = {
    {"InnerNodeOutOfRange", "chunk NODE: node 1 child 3 is node 2, but there are only 2", [](auto& s) { s.nodes[1].child[3] = package::kInnerChild; }},
    {"NoParent", "chunk NODE: node 1 has no parent", [](auto& s) { s.nodes[0].child[1] = package::kNoChild; }},
    {"ChildKind", "chunk NODE: node 1 child 2 is of the unknown kind 9", [](auto& s) { s.nodes[1].child[2] = 9; }},
    {"LeafTooLong", "chunk NODE: node 1 child 2 is a leaf over triangles 4 to 5, chunk LEAF has 5", [](auto& s) { s.nodes[1].child[2] = 2; }},
    {"LeafTooShort", "chunk LEAF: 5 triangles, the leaves in chunk NODE hold 4", [](auto& s) { s.nodes[0].child[0] = 1; }},
    {"BoundsInfinite", "chunk NODE: node 0 child 1 has bounds", [](auto& s) { *s.meta.bounds_max = {std::numeric_limits<float>::max(), 1, 1}; }},
    {"BoundsUpsideDown", "chunk NODE: node 0 child 1 has bounds", [](auto& s) { s.nodes[0].low[2][1] = s.nodes[0].high[2][1] = 40000; }},
    {"NoNodes", "chunk NODE is missing", [](auto& s) { s.nodes.clear(); }},
    {"NoLeaves", "chunk LEAF is missing", [](auto& s) { s.leaf_triangles.clear(); }},
    {"LeafTriangle", "chunk LEAF: entry 3 is triangle 5, chunk TRIS has 5", [](auto& s) { s.leaf_triangles[3] = 5; }},
    {"VertexNan", "chunk VPOS: vertex 10 is not finite", [](auto& s) { s.positions[10].y = kNan; }},
    {"VertexOutsideBounds", "chunk VPOS: vertex 8 lies outside the scene bounds", [](auto& s) { s.positions[8].x = 1.5f; }},
    {"PositionCount", "chunk VPOS: 14 vertices, chunk VATT has 15", [](auto& s) { s.positions.pop_back(); }},
    {"ExtrasCount", "chunk VEXT: 14 vertices, chunk VATT has 15", [](auto& s) { s.extras.pop_back(); }},
    {"MaterialOutOfRange", "chunk TRIS: triangle 0 refers to material 4", [](auto& s) { s.triangles[0].material = 4; }},
    {"AlphaOnOpaque", "chunk TRIS: triangle 0 is flagged for alpha", [](auto& s) { s.triangles[0].material |= gpu::kTriangleAlpha << package::kTriangleFlagsShift; }},
    {"ThinOnSolid", "chunk TRIS: triangle 0 is flagged as thin", [](auto& s) { s.triangles[0].material |= gpu::kTriangleThin << package::kTriangleFlagsShift; }},
    {"HasAlpha", "chunk META: has_alpha", [](auto& s) { s.meta.has_alpha = false; }},
    {"HasThin", "chunk META: has_alpha or has_thin", [](auto& s) { s.meta.has_thin = false; }},
    {"TriangleVertex", "chunk TRIS: triangle 2 refers to vertex 15", [](auto& s) { s.triangles[2].vertices.y = 15; }},
    {"UvNan", "chunk VATT: vertex 7 has texture coordinates", [](auto& s) { s.vertices[7].uv0.y = kNan; }},
    {"SecondUvNan", "chunk VEXT: vertex 7 has texture coordinates", [](auto& s) { s.extras[7].uv1.y = kNan; }},
    {"ColourInfinite", "chunk VEXT: vertex 8 has a colour", [](auto& s) { s.extras[8].color.y = 0x7c000000; }},
    {"BaseColour", "chunk MATL: material 0 has base_color outside 0 to 1", [](auto& s) { s.materials[0].base_color.y = 1.5f; }},
    {"Roughness", "chunk MATL: material 2 has roughness outside 0 to 1", [](auto& s) { s.materials[2].roughness = -0.1f; }},
    {"Transmission", "chunk MATL: material 3 has transmission outside 0 to 1", [](auto& s) { s.materials[3].transmission = kNan; }},
    {"Ior", "chunk MATL: material 3 has an index of refraction", [](auto& s) { s.materials[3].ior = 0.5f; }},
    {"EmissionInfinite", "chunk MATL: material 1 has emission outside 0 to infinity", [](auto& s) { s.materials[1].emission.z = kInf; }},
    {"AlphaCutoff", "chunk MATL: material 2 has alpha_cutoff outside 0 to infinity", [](auto& s) { s.materials[2].alpha_cutoff = -1; }},
    {"Sheen", "chunk MATL: material 1 has sheen_color outside 0 to 1", [](auto& s) { s.materials[1].sheen_color.z = 2; }},
    {"Film", "chunk MATL: material 1 has iridescence_ior outside 1 to infinity", [](auto& s) { s.materials[1].iridescence_ior = 0.5f; }},
    {"MaterialFlags", "chunk MATL: material 0 has unknown", [](auto& s) { s.materials[0].flags = 32; }},
    {"AlphaModes", "chunk MATL: material 2 has unknown or contradictory", [](auto& s) { s.materials[2].flags |= gpu::kMaterialAlphaBlend; }},
    {"MaterialTexture", "chunk MATL: material 0 refers to texture 2", [](auto& s) { s.materials[0].specular_color_texture = 2; }},
    {"LastTexture", "as its diffuse_transmission_color_texture", [](auto& s) { s.materials[0].diffuse_transmission_color_texture = 2; }},
    {"TexturePage", "chunk TREF: texture 1 refers to page 1", [](auto& s) { s.texture_refs[1].page = 1; }},
    {"TextureLayer", "chunk TREF: texture 1 refers to layer 2", [](auto& s) { s.texture_refs[1].layer = 2; }},
    {"SamplingWrap", "chunk TREF: texture 0 has unknown sampling", [](auto& s) { s.texture_refs[0].sampling = 3; }},
    {"SamplingBits", "chunk TREF: texture 0 has unknown sampling", [](auto& s) { s.texture_refs[0].sampling = 256; }},
    {"TextureSize", "chunk TREF: texture 0 is not where page 0", [](auto& s) { s.texture_refs[0].size = 4 | 5 << 16; }},
    {"TextureOrigin", "chunk TREF: texture 0 is not where page 0", [](auto& s) { s.texture_refs[0].origin = 4; }},
    {"TileInPlainPage", "chunk TREF: texture 0 is not where page 0", [](auto& s) { s.texture_refs[0].sampling = gpu::kSampleTile; }},
    {"PageOfBlocksTooLarge", "chunk TEXP 0: 168 bytes, but", [](auto& s) { s.meta.texture_pages[0]->encoding = lumicut::fb::TextureEncoding::Bc7Srgb; }},
    {"PageOfBlocksTooSmall", "chunk TEXP 0: 95 bytes, but", [](auto& s) { makeBlocks(s, 95); }},
    {"TiledPageWithLevels", "chunk META: texture page 0 is tiled and has 3", [](auto& s) { s.meta.texture_pages[0]->tiled = true; }},
    {"TilePastItsPage", "chunk TREF: texture 1 is not where page 0", [](auto& s) { makeTiles(s, 24); }},
    {"TileBetweenBlocks", "chunk TREF: texture 1 is not where page 0", [](auto& s) { makeTiles(s, 2); }},
    {"TextureTransform", "chunk TREF: texture 0 has a coordinate transform", [](auto& s) { s.texture_refs[0].v_row.z = kInf; }},
    {"PageTooSmall", "chunk TEXP 0: 167 bytes", [](auto& s) { s.texture_pages[0].pop_back(); }},
    {"PageMissing", "chunk TEXP 0: 0 bytes", [](auto& s) { s.texture_pages.clear(); }},
    {"PageUndescribed", "chunk TEXP 1: META describes only 1", [](auto& s) { s.texture_pages.push_back(s.texture_pages[0]); }},
    {"PageSize", "chunk META: texture page 0 is 4 x 0", [](auto& s) { s.meta.texture_pages[0]->height = 0; }},
    {"PageLayers", "chunk META: texture page 0 has 4000000000 layers", [](auto& s) { s.meta.texture_pages[0]->layers = 4000000000; }},
    {"PageLevels", "chunk META: texture page 0 has 4 mip levels, allowed are 1 to 3", [](auto& s) { s.meta.texture_pages[0]->levels = 4; }},
    {"PageEncoding", "chunk META: texture page 0 has the unknown encoding 9", [](auto& s) { s.meta.texture_pages[0]->encoding = lumicut::fb::TextureEncoding(9); }},
    {"LightKind", "chunk LITE: light 0 has the unknown kind 6", [](auto& s) { s.lights[0].kind = 6; }},
    {"LightNan", "chunk LITE: light 0 has a position", [](auto& s) { s.lights[0].p0.x = kNan; }},
    {"LightNegative", "chunk LITE: light 0 has an emission", [](auto& s) { s.lights[0].emission.y = -1; }},
    {"LightDirection", "chunk LITE: light 0 has a direction", [](auto& s) { s.lights[0].kind = gpu::kLightSpot; s.lights[0].p1 = {1, 1, 1}; }},
    {"LightTriangle", "chunk LITE: light 1 refers to triangle 9", [](auto& s) { s.lights[1].triangle = 9; }},
    {"LightTriangleTwice", "chunk LITE: light 1 claims triangle 1, which is light 0 already", [](auto& s) { s.lights[0].kind = gpu::kLightTriangle; s.lights[0].triangle = 1; }},
    {"LightMaterial", "chunk LITE: light 1 refers to material 4", [](auto& s) { s.lights[1].material = 4; }},
    {"LightMaterialUntextured", "chunk LITE: light 1 names material 0", [](auto& s) { s.lights[1].material = 0; }},
    {"PointWithTriangle", "chunk LITE: light 0 is no triangle", [](auto& s) { s.lights[0].triangle = 0; }},
    {"EnvironmentNotLast", "chunk LITE: light 0 is an environment", [](auto& s) { s.lights[0].kind = gpu::kLightEnvironment; }},
    {"EnvironmentWithoutMap", "chunk LITE: light 2 is an environment", [](auto& s) { s.environment_map.clear(); s.environment_texels.clear(); s.meta.environment.reset(); }},
    {"AliasCount", "chunk LALS: 2 entries for 3 lights", [](auto& s) { s.light_aliases.pop_back(); }},
    {"AliasOutOfRange", "chunk LALS: entry 0 has alias 3", [](auto& s) { s.light_aliases[0].alias = 3; }},
    {"AliasThreshold", "chunk LALS: entry 1 has threshold 1.5", [](auto& s) { s.light_aliases[1].threshold = 1.5f; }},
    {"YieldCount", "chunk LYLD: 2 entries for 3 lights", [](auto& s) { s.light_yields.pop_back(); }},
    {"YieldRange", "chunk LYLD: entry 1 is not within 0 and 1", [](auto& s) { s.light_yields[1].y = 1.5f; }},
    {"YieldNan", "chunk LYLD: entry 2 is not within 0 and 1", [](auto& s) { s.light_yields[2].z = kNan; }},
    {"PmfSum", "chunk LALS: the probabilities sum to 1.25", [](auto& s) { s.lights[0].pmf = 0.5f; }},
    {"PmfWrong", "chunk LALS: entry 0 is drawn with probability", [](auto& s) { std::swap(s.lights[0].pmf, s.lights[2].pmf); }},
    {"EnvironmentSize", "chunk ENVR: 8 texels, META says 5 x 2", [](auto& s) { s.meta.environment->width = 5; }},
    {"EnvironmentZero", "chunk META: the environment has a side of 0", [](auto& s) { s.meta.environment->height = 0; }},
    {"EnvironmentNan", "chunk ENVR: texel 3", [](auto& s) { s.environment_map[3].y = kNan; }},
    {"EnvironmentNegative", "chunk ENVR: texel 7", [](auto& s) { s.environment_map[7].z = -1; }},
    {"EnvironmentUndescribed", "chunk ENVR or EIMP is there", [](auto& s) { s.meta.environment.reset(); s.lights[2].kind = gpu::kLightPoint; }},
    {"EnvironmentRotation", "chunk META: the environment is turned by 3.2 radians", [](auto& s) { s.meta.environment->rotation = 3.2f; }},
    {"EnvironmentRotationNan", "chunk META: the environment is turned by nan", [](auto& s) { s.meta.environment->rotation = kNan; }},
    {"EnvironmentAverage", "chunk META: the environment's average radiance", [](auto& s) { s.meta.environment->average_radiance.reset(); }},
    {"ImportanceSize", "chunk EIMP: 2 texels, META says 2 x 2", [](auto& s) { s.meta.environment->importance_height = 2; }},
    {"ImportanceAlias", "chunk EIMP: entry 1 has alias 2", [](auto& s) { s.environment_texels[1].alias = 2; }},
    {"ImportanceProbability", "chunk EIMP: texel 0 has probability", [](auto& s) { s.environment_texels[0].probability = -0.5f; }},
    {"ImportanceZeroButDrawn", "chunk EIMP: entry 0 is drawn", [](auto& s) { s.environment_texels[0].probability = 0; s.environment_texels[1].probability = 1; }},
    {"CausticNan", "chunk CTGT: target 0", [](auto& s) { s.caustic_targets[0].center.x = kNan; }},
    {"CausticRadius", "chunk CTGT: target 0", [](auto& s) { s.caustic_targets[0].radius = 0; }},
    {"NoCamera", "chunk META: there is no camera", [](auto& s) { s.meta.cameras.clear(); }},
    {"CameraNan", "chunk META: camera 0 has a position", [](auto& s) { *s.meta.cameras[0]->position = {kNan, 0, 0}; }},
    {"CameraSkewed", "chunk META: camera 0: its forward and up", [](auto& s) { *s.meta.cameras[0]->up = {0, 0, 1}; }},
    {"CameraIncomplete", "chunk META: camera 0 lacks", [](auto& s) { s.meta.cameras[0]->up.reset(); }},
    {"CameraFov", "chunk META: camera 0 has a field of view of 3.2", [](auto& s) { s.meta.cameras[0]->vertical_fov = 3.2f; }},
    {"CameraBoth", "chunk META: camera 0 has a field of view", [](auto& s) { s.meta.cameras[0]->orthographic_height = 1; }},
    {"CameraNear", "chunk META: camera 0 has its near plane at -1", [](auto& s) { s.meta.cameras[0]->near_plane = -1; }},
    {"CameraNearNan", "chunk META: camera 0 has its near plane", [](auto& s) { s.meta.cameras[0]->near_plane = kNan; }},
    {"CameraFar", "chunk META: camera 0 has its near plane", [](auto& s) { s.meta.cameras[0]->near_plane = 2, s.meta.cameras[0]->far_plane = 2; }},
    {"CameraFarNan", "chunk META: camera 0 has its near plane", [](auto& s) { s.meta.cameras[0]->far_plane = kNan; }},
    {"BoundsMeta", "chunk META: the scene bounds", [](auto& s) { *s.meta.bounds_max = {-1, 1, 1}; }},
    {"OriginNan", "chunk META: the origin is not finite", [](auto& s) { s.meta.origin = std::make_unique<lumicut::fb::Vec3d>(0, kNan, 0); }},
    {"UnitZero", "chunk META: the unit of length is 0 m", [](auto& s) { s.meta.unit = 0; }},
    {"UnitInfinite", "chunk META: the unit of length is inf m", [](auto& s) { s.meta.unit = std::numeric_limits<double>::infinity(); }},
    {"MaterialNames", "chunk META: 3 material names for 4 materials", [](auto& s) { s.meta.material_names.pop_back(); }},
    {"NoStatistics", "chunk META: its FlatBuffer", [](auto& s) { s.meta.statistics.reset(); }},
};
// clang-format on

struct Content : testing::TestWithParam<ContentCase>
{
};

/// A chain of nodes with three leaves beside each next node: needs 3 stack entries a level.
void makeDeep(SamplePackage& sample, uint32_t levels)
{
    sample.nodes.assign(levels, {.low = {}, .high = {}, .child = {1, 1, 1, package::kInnerChild}});
    sample.nodes.back().child[3] = 1;
    sample.leaf_triangles.assign(3 * levels + 1, 0);
}
} // namespace

TEST_P(Content, IsRejectedByName)
{
    SamplePackage sample;
    GetParam().spoil(sample);
    const auto bytes = sample.bytes();
    const auto package = package::Package::openBytes(bytes);
    ASSERT_FALSE(package);
    EXPECT_EQ(package.error().code, ExitCode::kInvalid);
    EXPECT_NE(package.error().message.find(GetParam().words), std::string::npos) << package.error().message;
    EXPECT_EQ(package.error().message.find('\n'), std::string::npos);
}
INSTANTIATE_TEST_SUITE_P(Package, Content, testing::ValuesIn(kContentCases),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(TraversalStack, DeepestTreeThatFitsIsAcceptedAndOneLevelMoreIsNot)
{
    SamplePackage sample;
    makeDeep(sample, gpu::kTraversalStackSize / 3); // 21 levels x 3 = 63
    auto bytes = sample.bytes();
    EXPECT_TRUE(package::Package::openBytes(bytes));
    makeDeep(sample, gpu::kTraversalStackSize / 3 + 1);
    bytes = sample.bytes();
    const auto package = package::Package::openBytes(bytes);
    ASSERT_FALSE(package);
    EXPECT_NE(package.error().message.find("may need 66 stack entries"), std::string::npos) << package.error().message;
}

namespace
{
struct ShellCase
{
    const char* name;
    ExitCode code;
    const char* words;
    std::function<void(package::Header&, std::vector<package::ChunkEntry>&)> spoil;
};
void PrintTo(const ShellCase& c, std::ostream* out)
{
    *out << c.name;
}

constexpr uint32_t kUnknownChunk = package::fourcc("ZZZZ");

package::ChunkEntry& envr(std::vector<package::ChunkEntry>& table)
{
    return *std::find_if(table.begin(), table.end(), [](const auto& e) { return e.id == package::kEnvironmentChunk; });
}

// clang-format off
const ShellCase kShellCases[] = {
    {"NewerVersion", ExitCode::kUnsupported, "version 4.0", [](auto& h, auto&) { h.version_major = 4; h.version_minor = 0; }},
    {"OlderVersion", ExitCode::kUnsupported, "compile it again", [](auto& h, auto&) { h.version_major = 1; }},
    {"HeaderReserved", ExitCode::kInvalid, "header's reserved", [](auto& h, auto&) { h.reserved = 1; }},
    {"NoChunks", ExitCode::kInvalid, "counts 0 chunks", [](auto& h, auto&) { h.chunk_count = 0; }},
    {"ManyChunks", ExitCode::kInvalid, "counts 65 chunks", [](auto& h, auto&) { h.chunk_count = 65; }},
    {"TableOutside", ExitCode::kInvalid, "chunk table at byte", [](auto& h, auto&) { h.chunk_table_offset = ~0ull - 7; }},
    {"ChunkOutside", ExitCode::kInvalid, "chunk ENVR 0: 128 bytes at byte", [](auto&, auto& t) { envr(t).offset = 1ull << 40; }},
    {"ChunkOverflow", ExitCode::kInvalid, "chunk ENVR 0", [](auto&, auto& t) { envr(t).offset = ~0ull - 4095; }},
    {"ChunkLength", ExitCode::kInvalid, "chunk ENVR 0", [](auto&, auto& t) { envr(t).stored_bytes = envr(t).raw_bytes = ~0ull; }},
    {"Overlap", ExitCode::kInvalid, "overlaps chunk", [](auto&, auto& t) { envr(t).offset = t.back().offset; }},
    {"OverlapHeader", ExitCode::kInvalid, "overlaps", [](auto&, auto& t) { envr(t).offset = 0; }},
    {"Duplicate", ExitCode::kInvalid, "not sorted by id and index, or lists it twice", [](auto&, auto& t) { t[1].id = t[0].id; }},
    {"Unsorted", ExitCode::kInvalid, "not sorted", [](auto&, auto& t) { std::swap(t[0], t[1]); }},
    {"Alignment", ExitCode::kInvalid, "alignment 3000", [](auto&, auto& t) { envr(t).alignment = 3000; }},
    {"AlignmentSmall", ExitCode::kInvalid, "alignment 16 is not a power of two of at least 4096", [](auto&, auto& t) { envr(t).alignment = 16; }},
    {"Misaligned", ExitCode::kInvalid, "no multiple of its alignment", [](auto&, auto& t) { envr(t).offset += 4; }},
    {"RawSize", ExitCode::kInvalid, "stored without a codec", [](auto&, auto& t) { ++envr(t).raw_bytes; }},
    {"Codec", ExitCode::kUnsupported, "codec 2", [](auto&, auto& t) { envr(t).codec = package::Codec(2); }},
    {"Bomb", ExitCode::kInvalid, "allowed is at most 1024 times", [](auto&, auto& t) { envr(t).codec = package::Codec::kZstd; envr(t).raw_bytes = 1ull << 50; }},
    {"NoZstdFrame", ExitCode::kInvalid, "zstd frame", [](auto&, auto& t) { envr(t).codec = package::Codec::kZstd; }},
    {"EntryReserved", ExitCode::kInvalid, "its flags", [](auto&, auto& t) { envr(t).reserved = 1; }},
    {"UnknownRequired", ExitCode::kUnsupported, "chunk ZZZZ 0: this program does not know it", [](auto&, auto& t) { t.back().id = kUnknownChunk; }},
    {"Index", ExitCode::kInvalid, "only index 0 is allowed", [](auto&, auto& t) { envr(t).index = 1; }},
    {"PartialElement", ExitCode::kInvalid, "no whole number of elements of 16 bytes", [](auto&, auto& t) { envr(t).stored_bytes = envr(t).raw_bytes += 4; }},
};
// clang-format on

struct Shell : testing::TestWithParam<ShellCase>
{
};

template <typename Spoil>
std::vector<std::byte> spoiled(const Spoil& spoil)
{
    std::vector<std::byte> bytes = SamplePackage().bytes();
    package::Header header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    std::vector<package::ChunkEntry> table(header.chunk_count);
    std::byte* table_bytes = bytes.data() + sizeof(header);
    std::memcpy(table.data(), table_bytes, table.size() * sizeof(package::ChunkEntry));
    spoil(header, table);
    std::memcpy(bytes.data(), &header, sizeof(header));
    std::memcpy(table_bytes, table.data(), table.size() * sizeof(package::ChunkEntry));
    rehash(bytes);
    return bytes;
}
} // namespace

TEST_P(Shell, IsRejectedByName)
{
    const auto bytes = spoiled(GetParam().spoil);
    const auto package = package::Package::openBytes(bytes);
    ASSERT_FALSE(package);
    EXPECT_EQ(package.error().code, GetParam().code) << package.error().message;
    EXPECT_NE(package.error().message.find(GetParam().words), std::string::npos) << package.error().message;
}
INSTANTIATE_TEST_SUITE_P(Package, Shell, testing::ValuesIn(kShellCases),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Evolution, UnknownOptionalChunksAndHigherMinorVersionsAreIgnored)
{
    const auto bytes = spoiled(
        [](package::Header& header, std::vector<package::ChunkEntry>& table)
        {
            header.version_minor = 7;
            for (package::ChunkEntry& entry : table)
            {
                if (entry.id != package::kCausticTargetsChunk) // optional, so that the rest stays a whole package
                    continue;
                entry.id = package::fourcc("CTGZ");
                entry.required = 0;
                entry.codec = package::Codec(9);
            }
            std::sort(table.begin(), table.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
        });
    const auto package = package::Package::openBytes(bytes);
    ASSERT_TRUE(package) << package.error().message;
    EXPECT_TRUE(package->causticTargets().empty());
}
