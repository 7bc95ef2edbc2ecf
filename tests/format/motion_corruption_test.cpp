// One wrong field each in what moves: the reader must name the chunk and what is wrong.
#include "tests/format/sample_package.h"
#include "tests/format/walk_package.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace
{
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct MotionCase
{
    const char* name;
    const char* words; // that the message must hold
    std::function<void(SamplePackage&)> spoil;
};
void PrintTo(const MotionCase& c, std::ostream* out)
{
    *out << c.name;
}

lumicut::fb::ChannelT& channel(SamplePackage& s, size_t i)
{
    return *s.motion->clips[0]->channels[i];
}

// clang-format off
const MotionCase kMotionCases[] = {
    {"ParentAfter", "chunk MOTN: node 0 has the parent 1", [](auto& s) { s.motion->nodes[0]->parent = 1; }},
    {"OwnParent", "chunk MOTN: node 1 has the parent 1", [](auto& s) { s.motion->nodes[1]->parent = 1; }},
    {"ParentNegative", "chunk MOTN: node 1 has the parent -2", [](auto& s) { s.motion->nodes[1]->parent = -2; }},
    {"Translation", "chunk MOTN: node 0 has a transform", [](auto& s) { s.motion->nodes[0]->translation = std::make_unique<lumicut::fb::Double3>(kInf, 0.0, 0.0); }},
    {"Rotation", "chunk MOTN: node 0 has a rotation", [](auto& s) { s.motion->nodes[0]->rotation = std::make_unique<lumicut::fb::Double4>(0.0, 0.0, 0.0, 2.0); }},
    {"NodeWeights", "chunk MOTN: node 1 has morph weights 0 to 2, there are 1", [](auto& s) { s.motion->nodes[1]->weight_count = 2; }},
    {"NodeWeightsOverflow", "chunk MOTN: node 1 has morph weights", [](auto& s) { s.motion->nodes[1]->first_weight = 0xffffffffu; }},
    {"WeightNan", "chunk MOTN: morph weight 0", [](auto& s) { s.motion->weights[0] = kNan; }},
    {"BoneNode", "chunk MOTN: bone 1 refers to nodes 2 and 0", [](auto& s) { s.motion->bones[1]->node = 2; }},
    {"BoneShownBy", "chunk MOTN: bone 1 refers to nodes 1 and 2", [](auto& s) { s.motion->bones[1]->shown_by = 2; }},
    {"Bind", "chunk MOTN: bone 1 has a bind matrix", [](auto& s) { *s.motion->bones[1]->bind = {lumicut::fb::Double4(), lumicut::fb::Double4(kInf, 0.0, 0.0, 0.0), lumicut::fb::Double4()}; }},
    {"LightIndex", "chunk MOTN: light 0 refers to light 3 of 3", [](auto& s) { s.motion->lights[0]->light = 3; }},
    {"LightNode", "chunk MOTN: light 0 refers to light 0 of 3 in LITE and to node 2 of 2", [](auto& s) { s.motion->lights[0]->node = 2; }},
    {"LightKind", "chunk MOTN: light 0 refers to light 1 in LITE, which is no point", [](auto& s) { s.motion->lights[0]->light = 1; }},
    {"LightIntensity", "chunk MOTN: light 0 has a colour or an intensity", [](auto& s) { s.motion->lights[0]->intensity = -1; }},
    {"LightCone", "chunk MOTN: light 0 has a cone of 3 radians", [](auto& s) { s.motion->lights[0]->outer_cone = 3; }},
    {"CameraIndex", "chunk MOTN: camera 0 refers to camera 1 of 1", [](auto& s) { s.motion->cameras[0]->camera = 1; }},
    {"ObjectNode", "chunk MOTN: object 0 refers to node 2 of 2", [](auto& s) { s.motion->objects[0]->node = 2; }},
    {"ObjectTarget", "chunk MOTN: object 0 refers to node 0 of 2 and to caustic target 1", [](auto& s) { s.motion->objects[0]->caustic_target = 1; }},
    {"ObjectEmpty", "chunk MOTN: object 0 has 0 triangles", [](auto& s) { s.motion->objects[0]->triangle_count = 0; }},
    {"ObjectsEnd", "chunk MOTN: the objects' triangles end at 4, chunk TRIS has 5", [](auto& s) { s.motion->objects[0]->triangle_count = 2; }},
    {"ObjectsOverflow", "chunk MOTN: the objects' triangles end at", [](auto& s) { s.motion->objects[0]->triangle_count = 0xffffffffu; }},
    {"Material", "chunk MOTN: emission 0 is of material 4", [](auto& s) { s.motion->materials[0]->material = 4; }},
    {"Emission", "chunk MOTN: emission 0 is negative", [](auto& s) { s.motion->materials[0]->strength = -1; }},
    {"Duration", "chunk MOTN: clip 0 lasts 1 s, its last key is at 2 s", [](auto& s) { s.motion->clips[0]->duration = 1; }},
    {"DurationNan", "chunk MOTN: clip 0 lasts", [](auto& s) { s.motion->clips[0]->duration = kNan; }},
    {"Target", "chunk MOTN: clip 0 channel 1 has the unknown target 16", [](auto& s) { channel(s, 1).target = lumicut::fb::ChannelTarget(16); }},
    {"Interpolation", "chunk MOTN: clip 0 channel 1 has the unknown interpolation 3", [](auto& s) { channel(s, 1).interpolation = lumicut::fb::Interpolation(3); }},
    {"VisibilityBlends", "chunk MOTN: clip 0 channel 3 has the unknown interpolation", [](auto& s) { channel(s, 3).interpolation = lumicut::fb::Interpolation::Linear; }},
    {"ChannelNode", "chunk MOTN: clip 0 channel 1 sets a property of object 2", [](auto& s) { channel(s, 1).index = 2; }},
    {"ChannelLight", "chunk MOTN: clip 0 channel 4 sets a property of object 1", [](auto& s) { channel(s, 4).index = 1; }},
    {"ChannelCamera", "chunk MOTN: clip 0 channel 5 sets a property of object 1", [](auto& s) { channel(s, 5).index = 1; }},
    {"ChannelMaterial", "chunk MOTN: clip 0 channel 6 sets a property of object 4", [](auto& s) { channel(s, 6).index = 4; }},
    {"ChannelEmission", "chunk MOTN: clip 0 channel 6 sets the emission of material 0", [](auto& s) { channel(s, 6).index = 0; }},
    {"NoWeights", "chunk MOTN: clip 0 channel 2 sets morph weights of node 0", [](auto& s) { channel(s, 2).index = 0; }},
    {"CameraKind", "chunk MOTN: clip 0 channel 5 sets what camera 0 does not have", [](auto& s) { channel(s, 5).target = lumicut::fb::ChannelTarget::CameraHeight; }},
    {"MatrixMoves", "chunk MOTN: clip 0 channel 1 moves node 1, which has a matrix", [](auto& s) { s.motion->nodes[1]->matrix = std::make_unique<lumicut::fb::DoubleMatrix>(); }},
    {"NoKeys", "chunk MOTN: clip 0 channel 1 has 0 values for 0 keys", [](auto& s) { channel(s, 1).times.clear(); channel(s, 1).values.clear(); }},
    {"ValueCount", "chunk MOTN: clip 0 channel 0 has 17 values for 2 keys of 9", [](auto& s) { channel(s, 0).values.pop_back(); }},
    {"TimesFall", "chunk MOTN: clip 0 channel 1 key 1 is at 0 s", [](auto& s) { channel(s, 1).times[1] = 0; }},
    {"TimeNegative", "chunk MOTN: clip 0 channel 1 key 0 is at -1 s", [](auto& s) { channel(s, 1).times[0] = -1; }},
    {"TimeNan", "chunk MOTN: clip 0 channel 1 key 1", [](auto& s) { channel(s, 1).times[1] = kNan; }},
    {"ValueNan", "chunk MOTN: clip 0 channel 1 has a value", [](auto& s) { channel(s, 1).values[5] = kNan; }},
    {"VerticesWithoutMotion", "chunk MVTX, MINF or MMRF is there", [](auto& s) { s.motion.reset(); }},
    {"VerticesWithoutObjects", "chunk MVTX, MINF or MMRF is there", [](auto& s) { s.motion->objects.clear(); }},
    {"ManyVertices", "chunk MVTX: 16 vertices, chunk VPOS has 15", [](auto& s) { s.moving_vertices.resize(16); }},
    {"FewVertices", "chunk TRIS: triangle 2 moves but has a vertex that stands still", [](auto& s) { s.moving_vertices.erase(s.moving_vertices.begin()); s.moving_vertices[0].first_influence = s.moving_vertices[0].first_morph = 0; s.influences.erase(s.influences.begin(), s.influences.begin() + 2); s.morph_offsets.clear(); for (auto& v : s.moving_vertices) { v.first_morph = 0; v.first_influence -= v.first_influence > 0 ? 2 : 0; } }},
    {"FirstInfluence", "chunk MVTX: vertex 0 has influences 1 to 2", [](auto& s) { s.moving_vertices[0].first_influence = 1; }},
    {"InfluencesFall", "chunk MVTX: vertex 3 has influences 4 to 4", [](auto& s) { s.moving_vertices[4].first_influence = 4; }},
    {"InfluencesEnd", "chunk MVTX: vertex 7 has influences 8 to 11, chunk MINF has 10", [](auto& s) { s.moving_vertices[8].first_influence = 11; }},
    {"MorphsFall", "chunk MVTX: vertex 1 has morph offsets 1 to 0", [](auto& s) { s.moving_vertices[2].first_morph = 0; }},
    {"MorphsEnd", "chunk MVTX: vertex 7 has morph offsets 1 to 2, chunk MMRF has 1", [](auto& s) { s.moving_vertices[8].first_morph = 2; }},
    {"PositionNan", "chunk MVTX: vertex 2 is not finite", [](auto& s) { s.moving_vertices[2].position.z = kNan; }},
    {"Normal", "chunk MVTX: vertex 2 is not finite, or has a normal", [](auto& s) { s.moving_vertices[2].normal = {0, 0, 0}; }},
    {"TangentSign", "chunk MVTX: vertex 2 is not finite, or has a normal or tangent", [](auto& s) { s.moving_vertices[2].tangent.w = 0; }},
    {"InfluenceBone", "chunk MINF: entry 3 follows bone 2 of 2", [](auto& s) { s.influences[3].bone = 2; }},
    {"InfluenceWeight", "chunk MINF: entry 3 follows bone", [](auto& s) { s.influences[3].weight = -1; }},
    {"InfluenceNan", "chunk MINF: entry 3 follows bone", [](auto& s) { s.influences[3].weight = kNan; }},
    {"InfluenceSum", "chunk MVTX: vertex 0 has influences that sum to 0.75", [](auto& s) { s.influences[0].weight = 0.25f; }},
    {"MorphWeight", "chunk MMRF: entry 0 has weight 1, chunk MOTN has 1", [](auto& s) { s.morph_offsets[0].weight = 1; }},
    {"MorphNan", "chunk MMRF: entry 0 is not finite", [](auto& s) { s.morph_offsets[0].tangent.y = kNan; }},
    {"StillTriangleMoves", "chunk TRIS: triangle 0 stands still but has a vertex that moves", [](auto& s) { s.triangles[0].vertices.y = 6; }},
    {"MovingTriangleStill", "chunk TRIS: triangle 4 moves but has a vertex that stands still", [](auto& s) { s.triangles[4].vertices.y = 5; }},
    {"UnusedVertex", "chunk MVTX: no triangle has vertex", [](auto& s) { s.triangles[4].vertices = {12, 13, 13}; }},
    {"MovingLeafTwice", "chunk LEAF: entry 4 is triangle 3", [](auto& s) { s.leaf_triangles[4] = 3; }},
    {"MovingLeafFirst", "chunk LEAF: entry 1 is triangle 2", [](auto& s) { std::swap(s.leaf_triangles[1], s.leaf_triangles[2]); }},
    {"MixedNode", "chunk NODE: node 1 holds triangles that move and others", [](auto& s) { s.nodes[0].child[0] = 1; s.nodes[1].child = {1, 1, 1, 1}; }},
    {"NoNodeOfObject", "chunk NODE: no node holds object 0", [](auto& s) { s.nodes[0].child = {2, 1, package::kInnerChild, package::kNoChild}; s.nodes[1].child[2] = package::kNoChild; }},
    {"EmptyNode", "chunk NODE: node 1 holds no triangles", [](auto& s) { s.nodes.insert(s.nodes.begin() + 1, package::StoredNode{}); s.nodes[0].child = {2, package::kInnerChild, package::kInnerChild, package::kNoChild}; }},
};
// clang-format on

struct MotionContent : testing::TestWithParam<MotionCase>
{
};

TEST_P(MotionContent, IsRejectedByName)
{
    SamplePackage sample = SamplePackage::moving();
    GetParam().spoil(sample);
    const std::vector<std::byte> bytes = sample.bytes();
    const auto package = package::Package::openBytes(bytes);
    ASSERT_FALSE(package);
    EXPECT_EQ(package.error().code, ExitCode::kInvalid);
    EXPECT_NE(package.error().message.find(GetParam().words), std::string::npos) << package.error().message;
}
INSTANTIATE_TEST_SUITE_P(Package, MotionContent, testing::ValuesIn(kMotionCases),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Motion, ComesBackAsWritten)
{
    const SamplePackage sample = SamplePackage::moving();
    for (const int level : {0, 3})
    {
        const std::vector<std::byte> bytes = sample.bytes({.zstd_level = level});
        const auto package = package::Package::openBytes(bytes);
        ASSERT_TRUE(package) << package.error().message;
        ASSERT_NE(package->motion(), nullptr);
        EXPECT_EQ(package->motion()->clips()->Get(0)->name()->str(), "wave");
        EXPECT_EQ(package->movingVertices().size(), 9u);
        EXPECT_EQ(package->influences().size(), 10u);
        EXPECT_EQ(package->morphOffsets().size(), 1u);
        EXPECT_EQ(package->firstMovingNode(), 1u);
        EXPECT_EQ(package->firstMovingSlot(), 2u);
        EXPECT_EQ(package->firstMovingTriangle(), 2u);
        EXPECT_EQ(package->firstMovingVertex(), 6u);
        ASSERT_EQ(package->movingRanges().size(), 1u);
        const package::MovingRange& object = package->movingRanges()[0];
        EXPECT_EQ(object.root_node, 1u);
        EXPECT_EQ(object.node_count, 1u);
        EXPECT_EQ(object.first_slot, 2u);
        EXPECT_EQ(object.first_vertex, 6u);
        EXPECT_EQ(object.vertex_count, 9u);
        EXPECT_TRUE(std::isfinite(walkPackage(*package)));
    }
}

TEST(Motion, IsSkippedByReadersThatDoNotKnowIt)
{
    const std::vector<std::byte> bytes = SamplePackage::moving().bytes();
    const auto package = package::Package::openBytes(bytes);
    ASSERT_TRUE(package);
    for (const package::ChunkEntry& entry : package->chunks())
        EXPECT_EQ(entry.required, package::isRequired(entry.id)) << package::chunkName(entry.id);
}

TEST(Motion, PackagesWithoutItHaveNothingThatMoves)
{
    const std::vector<std::byte> bytes = SamplePackage().bytes();
    const auto package = package::Package::openBytes(bytes);
    ASSERT_TRUE(package);
    EXPECT_EQ(package->motion(), nullptr);
    EXPECT_TRUE(package->movingRanges().empty());
    EXPECT_EQ(package->firstMovingNode(), 2u);
    EXPECT_EQ(package->firstMovingSlot(), 5u);
    EXPECT_EQ(package->firstMovingTriangle(), 5u);
    EXPECT_EQ(package->firstMovingVertex(), 15u);
}
} // namespace
