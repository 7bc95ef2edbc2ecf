// What a file offers to choose from: scenes and variants of materials, and the list of it all.
#include "compiler/gltf_list.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

namespace
{
/// Scene "day" with one triangle, scene "night" with two; two materials that variants swap.
GltfBuilder offer()
{
    GltfBuilder builder;
    builder.material({{"name", "plain"}});
    builder.material({{"name", "red"}});
    builder.triangle(
        {{"material", 0},
         {"extensions", {{"KHR_materials_variants", {{"mappings", {{{"material", 1}, {"variants", {1, 2}}}}}}}}}});
    builder.node({{"mesh", 0}, {"translation", {0, 0, 1}}});
    builder.json["scenes"] = {{{"name", "day"}, {"nodes", {0}}}, {{"name", "night"}, {"nodes", {0, 1}}}};
    builder.json["extensionsUsed"] = {"KHR_materials_variants"};
    builder.json["extensions"]["KHR_materials_variants"]["variants"] = {
        {{"name", "as made"}}, {{"name", "worn"}}, {{"name", "new"}}};
    return builder;
}

Result<ImportedScene> importChoice(const GltfBuilder& builder, const ImportChoice& choice)
{
    const TemporaryFolder folder;
    const Result<GltfFile> file = builder.read(folder);
    if (!file)
        return file.error();
    return importScene(*file, choice);
}

TEST(Choice, ASceneIsChosenByNameOrIndex)
{
    for (const auto& [scene, objects] :
         std::vector<std::pair<std::string, size_t>>{{"", 1}, {"day", 1}, {"night", 2}, {"0", 1}, {"1", 2}})
    {
        const auto imported = importChoice(offer(), {.scene = scene, .variant = ""});
        ASSERT_TRUE(imported) << imported.error().message;
        EXPECT_EQ(imported->instances.size(), objects) << scene;
    }
    for (const char* scene : {"dusk", "2", "-1", "1x"})
    {
        const auto imported = importChoice(offer(), {.scene = scene, .variant = ""});
        ASSERT_FALSE(imported) << scene;
        EXPECT_EQ(imported.error().code, ExitCode::kUsage);
        EXPECT_NE(imported.error().message.find("\"night\" (1)"), std::string::npos) << imported.error().message;
    }
}

TEST(Choice, AFileWithoutScenesIsOneSceneOfAllItsNodes)
{
    GltfBuilder builder = offer();
    builder.json.erase("scenes");
    builder.json.erase("scene");
    builder.json["nodes"].push_back({{"children", {0}}, {"translation", {0, 5, 0}}}); // so that node 0 is no root
    const auto all = importChoice(builder, {});
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_EQ(all->instances.size(), 2u);
    EXPECT_EQ(all->scene.warnings.size(), 1u);
    const auto chosen = importChoice(builder, {.scene = "day", .variant = ""});
    ASSERT_FALSE(chosen);
    EXPECT_EQ(chosen.error().code, ExitCode::kUsage);
    builder.json["nodes"] = nlohmann::json::array();
    const auto nothing = importChoice(builder, {});
    ASSERT_FALSE(nothing);
    EXPECT_EQ(nothing.error().code, ExitCode::kInvalid);
}

TEST(Choice, WithoutADefaultSceneTheFirstIsTakenAndAChoiceNeedsNoWarning)
{
    GltfBuilder builder = offer();
    builder.json.erase("scene");
    const auto first = importChoice(builder, {});
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_EQ(first->instances.size(), 1u);
    EXPECT_EQ(first->scene.warnings.size(), 1u);
    const auto chosen = importChoice(builder, {.scene = "day", .variant = ""});
    ASSERT_TRUE(chosen) << chosen.error().message;
    EXPECT_TRUE(chosen->scene.warnings.empty());
}

TEST(Choice, AVariantSwapsTheMaterialsThatItMaps)
{
    for (const auto& [variant, material] : std::vector<std::pair<std::string, std::string>>{
             {"", "plain"}, {"as made", "plain"}, {"worn", "red"}, {"new", "red"}})
    {
        const auto imported = importChoice(offer(), {.scene = "", .variant = variant});
        ASSERT_TRUE(imported) << imported.error().message;
        EXPECT_EQ(imported->scene.material_names, std::vector<std::string>{material}) << variant;
    }
}

TEST(Choice, AnUnknownVariantListsWhatThereIs)
{
    const auto imported = importChoice(offer(), {.scene = "", .variant = "broken"});
    ASSERT_FALSE(imported);
    EXPECT_EQ(imported.error().code, ExitCode::kUsage);
    EXPECT_NE(imported.error().message.find("\"as made\", \"worn\", \"new\""), std::string::npos)
        << imported.error().message;
    GltfBuilder plain;
    plain.triangle();
    const auto none = importChoice(plain, {.scene = "", .variant = "broken"});
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("none"), std::string::npos) << none.error().message;
}

TEST(Choice, DamagedMappingsLeaveTheMaterialAndMaterialsOutOfRangeAreReported)
{
    GltfBuilder builder = offer();
    nlohmann::json& mappings =
        builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"];
    mappings = {1, {{"material", 1}}, {{"variants", {1}}}, {{"material", "1"}, {"variants", {1}}}};
    const auto kept = importChoice(builder, {.scene = "", .variant = "worn"});
    ASSERT_TRUE(kept) << kept.error().message;
    EXPECT_EQ(kept->scene.material_names, std::vector<std::string>{"plain"});
    mappings = {{{"material", 9}, {"variants", {1}}}};
    const auto bad = importChoice(builder, {.scene = "", .variant = "worn"});
    ASSERT_TRUE(bad) << bad.error().message;
    EXPECT_EQ(strictCode(bad), ExitCode::kInvalid);
    EXPECT_EQ(bad->scene.material_names, std::vector<std::string>{"plain"});
}

TEST(Choice, TheListNamesWhatTheFileHolds)
{
    GltfBuilder builder = offer();
    builder.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}},
                               {{"type", "orthographic"}, {"name", "plan"}}};
    builder.node({{"name", "door"}, {"camera", 0}});
    builder.json["animations"] = {{{"name", "op\x1b"
                                            "en"}},
                                  nlohmann::json::object()};
    builder.json["skins"] = {{{"joints", {0}}}};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"name", "sun"}, {"type", "directional"}}};
    builder.json["buffers"] = {{{"byteLength", 4}, {"uri", "not there.bin"}}}; // and is not needed
    const TemporaryFolder folder;
    const std::string text = builder.json.dump();
    writeBytes(folder / "offer.gltf", text.data(), text.size());
    const auto groups = listGltf(folder / "offer.gltf");
    ASSERT_TRUE(groups) << groups.error().message;
    EXPECT_EQ(listText(*groups), "scenes     2\n    0  \"day\" default\n    1  \"night\"\n"
                                 "variants   3\n    0  \"as made\"\n    1  \"worn\"\n    2  \"new\"\n"
                                 "cameras    2\n    0  \"door\" perspective\n    1  \"plan\" orthographic\n"
                                 "animations 2\n    0  \"op?en\"\n    1  \"\"\n"
                                 "skins      1\n    0  \"\"\n"
                                 "lights     1\n    0  \"sun\" directional\n"
                                 "materials  2\n    0  \"plain\"\n    1  \"red\"\n");
    const auto json = nlohmann::json::parse(listJson(*groups, folder / "offer.gltf"));
    EXPECT_EQ(json["schema"], "lumicut-compile-list/1");
    EXPECT_EQ(json["source"], "offer.gltf");
    EXPECT_EQ(json["scenes"][0], (nlohmann::json{{"name", "day"}, {"default", true}}));
    EXPECT_EQ(json["cameras"][1], (nlohmann::json{{"name", "plan"}, {"type", "orthographic"}}));
    EXPECT_EQ(json["materials"].size(), 2u);
}

TEST(Choice, ListingAFileThatIsNoGltfIsAnError)
{
    const TemporaryFolder folder;
    writeBytes(folder / "no.gltf", "{", 1);
    EXPECT_EQ(listGltf(folder / "no.gltf").error().code, ExitCode::kInvalid);
    EXPECT_EQ(listGltf(folder / "gone.gltf").error().code, ExitCode::kIo);
}
} // namespace
