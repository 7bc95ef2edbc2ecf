// A damaged item is a warning: everything else is compiled, and the report names its replacement.
#include "compiler/compile.h"
#include "compiler/report.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

#include <functional>

namespace
{
/// A textured, lit triangle with a camera on node 0, and another object on node 1 that may be damaged.
struct Scene : GltfBuilder
{
    Scene()
    {
        const int image = texture(2, 2, std::vector<uint8_t>(16, 255));
        material({{"name", "good"}});
        material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", image}}}}},
                  {"normalTexture", {{"index", image}}},
                  {"emissiveFactor", {1, 1, 1}},
                  {"emissiveTexture", {{"index", image}}}});
        triangle({{"material", 0}});
        const int uv = accessor(std::vector<float>{0, 1, 1, 1, 0, 0}, "VEC2", 5126, 3);
        const int indices = accessor(std::vector<uint16_t>{0, 1, 2}, "SCALAR", 5123, 3);
        triangle({{"material", 1}, {"indices", indices}, {"attributes", {{"TEXCOORD_0", uv}}}});
        json["samplers"] = {{{"wrapS", 10497}}};
        json["extensionsUsed"] = {"KHR_lights_punctual"};
        json["cameras"] = {perspective(), perspective()};
        json["extensions"]["KHR_lights_punctual"]["lights"] = {
            {{"type", "directional"}, {"intensity", 5}},
            {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}}};
        for (int i = 0; i < 2; ++i)
        {
            json["nodes"][i]["camera"] = i;
            json["nodes"][i]["translation"] = {0, 0, i};
            json["nodes"][i]["extensions"]["KHR_lights_punctual"]["light"] = i;
        }
        json["scenes"][0]["nodes"] = {0, 1};
    }
    nlohmann::json& at(const char* pointer) { return json[nlohmann::json::json_pointer(pointer)]; }

    static nlohmann::json perspective()
    {
        return {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}};
    }
};

struct BadItem
{
    const char* name;
    const char* place; // what is damaged
    nlohmann::json value;
    WarningKind kind;
    const char* pointer; // that the warning names
    const char* stand_in;
    size_t triangles = 2; // that are left
    size_t cameras = 2;
    size_t lights = 2;
};

using nlohmann::json;
constexpr WarningKind kDangling = WarningKind::kDanglingIndex;
constexpr WarningKind kRange = WarningKind::kOutOfRange;
constexpr WarningKind kMalformed = WarningKind::kMalformed;
constexpr const char* kYfov = "/cameras/1/perspective/yfov";
#define LIGHT "/extensions/KHR_lights_punctual/lights/1"
#define SPOT LIGHT "/spot"

const std::vector<BadItem> kBadItems{
    {"CameraInDegrees", kYfov, 60, kRange, kYfov, "it is taken as degrees"},
    {"CameraTooWide", kYfov, 400, kRange, kYfov, "it is taken as 45 degrees"},
    {"CameraNotANumber", kYfov, nullptr, kMalformed, kYfov, "it is taken as 45 degrees"},
    {"CameraWithoutNear", "/cameras/1/perspective", json::object({{"yfov", 0.8}}), kMalformed, "/cameras/1/perspective",
     "nothing is cut off near the camera"},
    {"CameraFarBeforeNear", "/cameras/1/perspective/zfar", 0.01, kRange, "/cameras/1/perspective/zfar",
     "nothing is cut off far away"},
    {"CameraAspect", "/cameras/1/perspective/aspectRatio", 0, kRange, "/cameras/1/perspective/aspectRatio",
     "that of the picture counts"},
    {"CameraMirrored",
     "/cameras/1",
     {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", -2}, {"znear", 0}, {"zfar", 9}}}},
     kRange,
     "/cameras/1/orthographic/ymag",
     "it is taken without its sign"},
    {"CameraType", "/cameras/1", json::object({{"type", "fisheye"}}), kMalformed, "/cameras/1",
     "the camera is left out", 2, 1},
    {"CameraIsNoObject", "/cameras/1", 7, kMalformed, "/cameras/1", "it is taken as empty", 2, 1},
    {"LightType", LIGHT "/type", "area", kMalformed, LIGHT, "the light is left out", 2, 2, 1},
    {"LightNegative", LIGHT "/intensity", -3, kRange, LIGHT "/intensity", "the nearest allowed value counts"},
    {"LightNull", LIGHT "/intensity", nullptr, kMalformed, LIGHT "/intensity", "its default counts"},
    {"LightColour", LIGHT "/color", {1, 2}, kMalformed, LIGHT "/color", "its default counts"},
    {"LightRange", LIGHT "/range", 0, kRange, LIGHT "/range", "it reaches without end"},
    {"SpotInnerAboveOuter", SPOT "/innerConeAngle", 0.6, kRange, SPOT "/innerConeAngle",
     "it is taken as the outer angle: the rim is hard"},
    {"SpotInDegrees", SPOT "/outerConeAngle", 30, kRange, SPOT "/outerConeAngle",
     "both cone angles are taken as degrees"},
    {"NodeMesh", "/nodes/1/mesh", 77, kDangling, "/nodes/1/mesh", "nothing is drawn for it", 1},
    {"NodeCamera", "/nodes/1/camera", -1, kDangling, "/nodes/1/camera", "the camera is left out", 2, 1},
    {"NodeLight", "/nodes/1/extensions/KHR_lights_punctual/light", "x", kDangling,
     "/nodes/1/extensions/KHR_lights_punctual/light", "the light is left out", 2, 2, 1},
    {"NodeChild", "/nodes/1/children", {9}, kDangling, "/nodes/1/children/0", "it is left out"},
    {"NodeTranslation",
     "/nodes/1/translation",
     {nullptr, 0, 0},
     kMalformed,
     "/nodes/1/translation",
     "the node is not moved"},
    {"NodeQuaternion", "/nodes/1/rotation", {0, 0, 0, 0}, kRange, "/nodes/1/rotation", "the node is not turned"},
    {"NodeTwoParents", "/nodes/2", json::object({{"children", {1, 1}}}), kMalformed, "/nodes/2/children/1",
     "it stays with that one", 1, 1, 1},
    {"NodeOwnChild", "/nodes/1/children", {1}, kMalformed, "/nodes/1/children", "it has no parent"},
    {"SceneIndex", "/scene", 3, kDangling, "/scene", "the first scene counts"},
    {"SceneRootTwice", "/scenes/0/nodes", {0, 1, 1}, kMalformed, "/scenes/0/nodes/2", "it is placed once"},
    {"PrimitiveMaterial", "/meshes/1/primitives/0/material", 77, kDangling, "/meshes/1/primitives/0/material",
     "the default material counts"},
    {"PrimitiveIndices", "/meshes/1/primitives/0/indices", 77, kDangling, "/meshes/1/primitives/0/indices",
     "the primitive is left out", 1},
    {"PrimitivePositions", "/meshes/1/primitives/0/attributes/POSITION", 77, kDangling,
     "/meshes/1/primitives/0/attributes/POSITION", "the primitive is left out", 1},
    {"PrimitiveAttribute", "/meshes/1/primitives/0/attributes/NORMAL", 77, kDangling,
     "/meshes/1/primitives/0/attributes/NORMAL", "the attribute is left out"},
    {"PrimitiveMode", "/meshes/1/primitives/0/mode", 9, kMalformed, "/meshes/1/primitives/0/mode",
     "the primitive is left out", 1},
    {"MeshEmpty", "/meshes/1", json::object(), kMalformed, "/meshes/1", "nothing is drawn for it", 1},
    {"AccessorType",
     "/accessors/4",
     {{"type", "VEC5"}, {"componentType", 5126}, {"count", 3}},
     kMalformed,
     "/accessors/4",
     "what it would hold is left out"},
    {"AccessorUnused",
     "/accessors/4",
     {{"type", "VEC3"}, {"componentType", 5126}, {"count", 3}, {"bufferView", 99}},
     kDangling,
     "/accessors/4/bufferView",
     "what it would hold is left out"},
    {"ViewStride",
     "/bufferViews/5",
     {{"buffer", 0}, {"byteLength", 4}, {"byteStride", 3}},
     kMalformed,
     "/bufferViews/5",
     "what it would hold is left out"},
    {"ViewTooLong",
     "/bufferViews/5",
     {{"buffer", 0}, {"byteLength", 100000}},
     kMalformed,
     "/bufferViews/5",
     "what it would hold is left out"},
    {"ViewUnused",
     "/bufferViews/5",
     {{"buffer", 4}, {"byteLength", 4}},
     kDangling,
     "/bufferViews/5/buffer",
     "what it would hold is left out"},
    {"TextureIndex", "/materials/1/normalTexture/index", 77, kDangling, "/materials/1/normalTexture/index",
     "the surface keeps its normals"},
    {"TextureSource", "/textures/1", json::object({{"source", 77}}), kDangling, "/textures/1/source",
     "materials that name the texture go without it"},
    {"TextureSampler", "/textures/0/sampler", 77, kDangling, "/textures/0/sampler", "the texture repeats"},
    {"SamplerWrap", "/samplers/0/wrapS", 5, kMalformed, "/samplers/0/wrapS", "the texture repeats"},
    {"MaterialFactor", "/materials/0/pbrMetallicRoughness/roughnessFactor", 7, kRange,
     "/materials/0/pbrMetallicRoughness/roughnessFactor", "the nearest allowed value counts"},
    {"MaterialColour",
     "/materials/0/pbrMetallicRoughness/baseColorFactor",
     {1, 1, 1},
     kMalformed,
     "/materials/0/pbrMetallicRoughness/baseColorFactor",
     "its default counts"},
    {"MaterialAlphaMode", "/materials/0/alphaMode", "GLASS", kMalformed, "/materials/0/alphaMode", "it is opaque"},
    {"MaterialExtensionFactor", "/materials/0/extensions/KHR_materials_ior/ior", 0.5, kRange,
     "/materials/0/extensions/KHR_materials_ior/ior", "it is taken as 1"},
    {"ListIsNoArray", "/samplers", 3, kMalformed, "/samplers", "it is taken as empty"},
    {"MissingImage", "/images/0", json::object({{"uri", "gone.png"}}), WarningKind::kUnreadable, "/images/0",
     "in its place: no emission, the base colour factor alone, the surface's own normals"},
    {"ImageFromNowhere", "/images/0", json::object(), WarningKind::kUnreadable, "/images/0",
     "in its place: no emission, the base colour factor alone, the surface's own normals"},
};

class Repair : public testing::TestWithParam<BadItem>
{
};

TEST_P(Repair, CompilesTheRestAndSaysWhatStandsInItsPlace)
{
    const BadItem& bad = GetParam();
    Scene scene;
    scene.at(bad.place) = bad.value;
    const TemporaryFolder folder;
    scene.writeGltf(folder / "scene.gltf");
    CompileOptions options{.input = folder / "scene.gltf", .output = folder / "scene.lumi"};
    options.default_light = DefaultLight::kOff;
    const Result<CompileReport> report = compile(options);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->meta.statistics->triangles, bad.triangles);
    EXPECT_EQ(report->meta.cameras.size(), bad.cameras);
    EXPECT_EQ(report->point_lights + report->spot_lights + report->directional_lights, bad.lights);
    const Warnings damage = damageAmong(report->warnings);
    ASSERT_FALSE(damage.empty());
    EXPECT_EQ(damage[0].kind, bad.kind);
    EXPECT_EQ(damage[0].pointer, bad.pointer);
    EXPECT_EQ(damage[0].stand_in, bad.stand_in);
    const json written = json::parse(reportJson(*report, options));
    EXPECT_EQ(written["findings"][0]["pointer"], bad.pointer);
    EXPECT_EQ(written["findings"][0]["kind"], kindName(bad.kind));
    EXPECT_EQ(written["findings"][0]["damage"], true);
    EXPECT_NE(written["warnings"].dump().find(bad.pointer), std::string::npos);

    options.strict = true;
    const Result<CompileReport> refused = compile(options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ExitCode::kInvalid);
    EXPECT_EQ(refused.error().details.size(), damage.size());
}
INSTANTIATE_TEST_SUITE_P(Kinds, Repair, testing::ValuesIn(kBadItems),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(RepairScene, AGoodOneHasNoDamage)
{
    const TemporaryFolder folder;
    Scene().writeGltf(folder / "scene.gltf");
    CompileOptions options{.input = folder / "scene.gltf", .output = folder / "scene.lumi"};
    options.strict = true;
    const Result<CompileReport> report = compile(options);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(report->warnings.empty());
    EXPECT_EQ(report->meta.statistics->emissive_triangles, 1u);
}

TEST(RepairScene, WithoutItsMapNothingGlows)
{
    Scene scene;
    scene.at("/images/0") = json::object({{"uri", "gone.png"}});
    const Result<SceneData> made = scene.scene();
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(made->images.empty());
    EXPECT_TRUE(made->texture_uses.empty());
    EXPECT_EQ(made->materials[1].base_color_texture, gpu::kNone);
    EXPECT_EQ(made->materials[1].emission.x, 0);
}

TEST(RepairScene, AMissingBufferTakesOnlyWhatLiesInIt)
{
    Scene scene;
    scene.at("/buffers/1") = {{"uri", "gone.bin"}, {"byteLength", 400}};
    scene.at("/bufferViews/5") = {{"buffer", 1}, {"byteLength", 36}};
    scene.at("/accessors/4") = {{"bufferView", 5}, {"type", "VEC3"}, {"componentType", 5126}, {"count", 3}};
    scene.at("/meshes/1/primitives/0/attributes/NORMAL") = 4;
    const Result<SceneData> made = scene.scene();
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->mesh.triangles.size(), 2u);
    ASSERT_EQ(made->warnings.size(), 2u);
    EXPECT_EQ(made->warnings[0].pointer, "/buffers/1");
    EXPECT_EQ(made->warnings[0].code, ExitCode::kIo);
    EXPECT_EQ(made->warnings[1].pointer, "/meshes/1/primitives/0/attributes/NORMAL");
}

TEST(RepairScene, ACycleOfNodesIsCutAndAllOfThemAreDrawn)
{
    Scene scene;
    scene.at("/nodes/1/children") = {2};
    scene.at("/nodes/2") = {{"mesh", 0}, {"children", {1}}};
    const Result<SceneData> made = scene.scene();
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->mesh.triangles.size(), 3u);
    ASSERT_EQ(made->warnings.size(), 1u);
    EXPECT_EQ(made->warnings[0].pointer, "/nodes/2/children");
    EXPECT_EQ(made->warnings[0].message, "node 1 is its own ancestor");
}

TEST(RepairScene, AnAccessorOfTooManyElementsTakesOnlyItsPrimitive)
{
    Scene scene;
    const int positions = scene.at("/meshes/1/primitives/0/attributes/POSITION");
    for (const uint64_t count : {uint64_t(4), uint64_t(1'000'000'000), uint64_t(1) << 63})
    {
        scene.json["accessors"][size_t(positions)]["count"] = count;
        const Result<SceneData> made = scene.scene();
        ASSERT_TRUE(made) << made.error().message;
        EXPECT_EQ(made->mesh.triangles.size(), 1u);
        ASSERT_EQ(damageAmong(made->warnings).size(), 1u);
        EXPECT_NE(made->warnings[0].message.find("reaches past the end"), std::string::npos);
    }
}

TEST(RepairScene, WhereNothingIsLeftTheErrorSaysWhy)
{
    GltfBuilder builder;
    builder.triangle();
    builder.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 9;
    const TemporaryFolder folder;
    builder.writeGltf(folder / "scene.gltf");
    const Result<CompileReport> report = compile({.input = folder / "scene.gltf", .output = folder / "scene.lumi"});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ExitCode::kInvalid);
    ASSERT_EQ(report.error().details.size(), 1u);
    EXPECT_NE(report.error().details[0].find("/meshes/0/primitives/0/attributes/POSITION"), std::string::npos);
}

TEST(RepairScene, ManyAlikeAreSummedInWordsAndListedInTheReport)
{
    Scene scene;
    for (int i = 0; i < 12; ++i)
        scene.material({{"pbrMetallicRoughness", {{"metallicFactor", 2 + i}}}});
    const TemporaryFolder folder;
    scene.writeGltf(folder / "scene.gltf");
    const CompileOptions options{.input = folder / "scene.gltf", .output = folder / "scene.lumi"};
    const Result<CompileReport> report = compile(options);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->warnings.size(), 12u);
    EXPECT_EQ(report->meta.provenance->warnings,
              std::vector<std::string>{"metallicFactor is 2, outside 0 to 1; the nearest allowed value counts "
                                       "(/materials/2/pbrMetallicRoughness/metallicFactor) and 11 more like it"});
    EXPECT_EQ(json::parse(reportJson(*report, options))["findings"].size(), 12u);
}
} // namespace
