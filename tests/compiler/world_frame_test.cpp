// Scenes far from 0, very small or very large must come out as their copies near 0 and of ordinary size.
#include "compiler/world_frame.h"

#include "compiler/compile.h"
#include "compiler/flatten.h"
#include "format/package_read.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

#include <cstring>

namespace
{
using Place = std::array<double, 3>;

/// A lit stair of quads, 4 m wide, with one camera each way, a lamp, a spot, a sun and tinted glass, under a node that
/// puts and scales it. What is not a length in the file's light list and materials is scaled along, so that the picture
/// stays the same.
GltfBuilder site(const Place& at, double scale = 1)
{
    GltfBuilder builder;
    builder.material({{"name", "wall"}});
    builder.material({{"name", "lamp"}, {"emissiveFactor", {1, 0.5, 0.25}}});
    builder.material(
        {{"name", "glass"},
         {"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
           {"KHR_materials_volume",
            {{"thicknessFactor", 1}, {"attenuationDistance", 0.5 * scale}, {"attenuationColor", {0.25, 0.5, 1}}}}}}});
    nlohmann::json children = nlohmann::json::array();
    for (int step = 0; step < 6; ++step)
    {
        const float y = float(step) * 0.25f - 0.75f;
        const int positions = builder.positions({-2, y, -y, 2, y, -y, 2, y + 0.125f, -y - 1, -2, y, -y - 1});
        const int indices = builder.accessor(std::vector<uint8_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5121, 6);
        children.push_back(builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", positions}}},
                                                                {"indices", indices},
                                                                {"material", step % 3}})}}));
    }
    const double area = scale * scale; // W/sr
    builder.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_transmission", "KHR_materials_volume"};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 8 * area}},
        {{"type", "spot"}, {"intensity", 4 * area}, {"spot", nlohmann::json::object()}},
        {{"type", "directional"}, {"intensity", 2}}};
    for (int light = 0; light < 3; ++light)
        children.push_back(builder.node(
            {{"translation", {light - 1, 1.5, 0.5}}, {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}}));
    builder.json["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", scale}, {"ymag", scale}, {"znear", 0}, {"zfar", 9}}}}};
    for (int camera = 0; camera < 2; ++camera)
        children.push_back(
            builder.node({{"translation", {0.25, 0.5, camera + 0.5}}, {"camera", camera}, {"name", "eye"}}));
    const int root = builder.node({{"translation", at}, {"scale", {scale, scale, scale}}, {"children", children}});
    builder.json["scenes"][0]["nodes"] = {root};
    return builder;
}

struct Made
{
    CompileReport report;
    package::Package package;
};

Result<Made> make(const GltfBuilder& builder, std::vector<CameraView> views = {})
{
    const TemporaryFolder folder;
    builder.writeGltf(folder / "site.gltf");
    CompileOptions options{.input = folder / "site.gltf", .output = folder / "site.lumi"};
    options.views = std::move(views);
    Result<CompileReport> report = compile(options);
    if (!report)
        return report.error();
    Result<package::Package> package = package::Package::open(options.output); // stays mapped
    if (!package)
        return package.error();
    return Made{std::move(*report), std::move(*package)};
}

template <typename T>
bool equalBytes(std::span<const T> a, std::span<const T> b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

std::array<float, 3> floats(const lumicut::fb::Vec3& v)
{
    return {v.x(), v.y(), v.z()};
}

/// Everything that a picture depends on, bit by bit.
void expectSamePicture(const package::Package& a, const package::Package& b)
{
    EXPECT_TRUE(equalBytes(a.bvhNodes(), b.bvhNodes()));
    EXPECT_TRUE(equalBytes(a.bvhTriangles(), b.bvhTriangles()));
    EXPECT_TRUE(equalBytes(a.vertexAttributes(), b.vertexAttributes()));
    EXPECT_TRUE(equalBytes(a.materials(), b.materials()));
    EXPECT_TRUE(equalBytes(a.lights(), b.lights()));
    EXPECT_TRUE(equalBytes(a.lightAliases(), b.lightAliases()));
    EXPECT_TRUE(equalBytes(a.causticTargets(), b.causticTargets()));
    const auto& views_a = *a.meta().cameras();
    const auto& views_b = *b.meta().cameras();
    ASSERT_EQ(views_a.size(), views_b.size());
    for (uint32_t i = 0; i < views_a.size(); ++i)
    {
        EXPECT_EQ(floats(*views_a.Get(i)->position()), floats(*views_b.Get(i)->position())) << i;
        EXPECT_EQ(floats(*views_a.Get(i)->forward()), floats(*views_b.Get(i)->forward())) << i;
        EXPECT_EQ(views_a.Get(i)->orthographic_height(), views_b.Get(i)->orthographic_height()) << i;
    }
}

size_t warningsAbout(const CompileReport& report, const std::string& words)
{
    const std::vector<std::string>& all = report.meta.provenance->warnings;
    return size_t(std::count_if(all.begin(), all.end(),
                                [&](const std::string& w) { return w.find(words) != std::string::npos; }));
}

TEST(WorldFrame, AMapCoordinateMovesTheOriginAndNothingElse)
{
    const CameraView near{.name = "mine", .position = {1, 1.5, 2}, .vertical_fov = 1};
    CameraView far = near;
    far.position = far.position + Vec3d{2.6e6, 400, -1.2e6};
    const Result<Made> local = make(site({0, 0, 0}), {near});
    const Result<Made> moved = make(site({2.6e6, 400, -1.2e6}), {far});
    ASSERT_TRUE(local && moved);
    EXPECT_EQ(local->package.meta().origin(), nullptr);
    const lumicut::fb::Vec3d* const origin = moved->package.meta().origin();
    ASSERT_NE(origin, nullptr);
    EXPECT_EQ(Place({origin->x(), origin->y(), origin->z()}), Place({2.6e6, 400, -1.2e6}));
    EXPECT_EQ(moved->package.meta().unit(), 1);
    expectSamePicture(local->package, moved->package);
}

TEST(WorldFrame, TheOriginIsThatOfAnObjectSoThatUnevenCoordinatesRoundNoVertex)
{
    const Place at{12958095.124, 40.3, -4865499.47};
    const Result<Made> local = make(site({0, 0, 0}));
    const Result<Made> moved = make(site(at));
    ASSERT_TRUE(local && moved);
    const lumicut::fb::Vec3d* const origin = moved->package.meta().origin();
    ASSERT_NE(origin, nullptr);
    EXPECT_EQ(Place({origin->x(), origin->y(), origin->z()}), at);
    EXPECT_TRUE(equalBytes(local->package.bvhTriangles(), moved->package.bvhTriangles()));
    EXPECT_TRUE(equalBytes(local->package.vertexAttributes(), moved->package.vertexAttributes()));
    // The camera's place is a sum in the file's coordinates: rounded to half a step of doubles below 2^24.
    for (uint32_t i = 0; i < 2; ++i)
    {
        const auto a = floats(*local->package.meta().cameras()->Get(i)->position());
        const auto b = floats(*moved->package.meta().cameras()->Get(i)->position());
        for (size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(a[axis], b[axis], 0x1p-29 + a[axis] * 0x1p-24);
    }
}

TEST(WorldFrame, VerticesInMapCoordinatesAreMovedWithoutLoss)
{
    GltfBuilder builder;
    const std::vector<float> file{1048577, 3, -2097153, 1048579.5f, 3, -2097153, 1048577, 4.25f, -2097154};
    builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", builder.positions(file)}}}})}});
    Result<ImportedScene> imported = builder.import();
    ASSERT_TRUE(imported) << imported.error().message;
    const WorldFrame frame = chooseFrame(*imported);
    ASSERT_TRUE(moveIntoFrame(*imported, frame));
    const Result<WorldMesh> mesh = flatten(*imported, imported->scene.counts, imported->scene.warnings);
    ASSERT_TRUE(mesh) << mesh.error().message;
    for (size_t i = 0; i < 3; ++i)
    {
        const gpu::vec3 p = mesh->positions[i];
        EXPECT_LE(std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}), 16) << i;
        EXPECT_EQ(toDouble(p) + frame.origin, (Vec3d{file[3 * i], file[3 * i + 1], file[3 * i + 2]})) << i;
    }
}

TEST(WorldFrame, WithoutCamerasTheMedianTriangleSetsTheOriginAndALargeGroundDoesNot)
{
    for (const double offset : {0.0, 1e6})
    {
        GltfBuilder builder = site({offset, 0, 0});
        builder.json.erase("cameras");
        for (nlohmann::json& node : builder.json["nodes"])
            node.erase("camera");
        const int ground = builder.mesh(
            {{"attributes", {{"POSITION", builder.positions({-1e5f, -1, 1e5f, 3e5f, -1, 1e5f, 3e5f, -1, -3e5f})}}}});
        builder.json["scenes"][0]["nodes"].push_back(builder.node({{"mesh", ground}, {"translation", {offset, 0, 0}}}));
        const Result<ImportedScene> imported = builder.import();
        ASSERT_TRUE(imported) << imported.error().message;
        const WorldFrame frame = chooseFrame(*imported);
        EXPECT_EQ(frame.origin, (Vec3d{offset, 0, 0}));
        EXPECT_EQ(frame.unit, 1);
    }
}

TEST(WorldFrame, ACameraFarOffItsSceneDoesNotDrawTheOriginThere)
{
    GltfBuilder builder = site({0, 0, 0});
    for (nlohmann::json& node : builder.json["nodes"])
        if (node.contains("camera"))
            node["translation"] = {0, 0, 1e6};
    const Result<ImportedScene> imported = builder.import();
    ASSERT_TRUE(imported) << imported.error().message;
    EXPECT_EQ(chooseFrame(*imported).origin, Vec3d{});
}

/// Scales that are powers of two are exact, so that nothing but lengths may differ.
TEST(WorldFrame, AThousandthToAThousandTimesTheSizeIsMeasuredInMetres)
{
    const Result<Made> ordinary = make(site({0, 0, 0}));
    ASSERT_TRUE(ordinary) << ordinary.error().message;
    for (const double scale : {0x1p-10, 1.0, 0x1p10})
    {
        const Result<Made> made = make(site({0, 0, 0}, scale));
        ASSERT_TRUE(made) << made.error().message;
        EXPECT_EQ(made->report.meta.unit, 1) << scale;
        EXPECT_EQ(made->report.meta.origin, nullptr) << scale;
        EXPECT_EQ(warningsAbout(made->report, "units of"), 0u) << scale;
        const package::Package &a = ordinary->package, &b = made->package;
        EXPECT_TRUE(equalBytes(a.vertexAttributes(), b.vertexAttributes())) << scale;
        EXPECT_TRUE(equalBytes(a.triangles(), b.triangles())) << scale;
        ASSERT_EQ(a.bvhNodes().size(), b.bvhNodes().size()) << scale;
        for (size_t i = 0; i < a.bvhNodes().size(); ++i)
        {
            const gpu::uvec4 x = a.bvhNodes()[i].child, y = b.bvhNodes()[i].child;
            EXPECT_TRUE(x.x == y.x && x.y == y.y && x.z == y.z && x.w == y.w) << i << " scale " << scale;
            EXPECT_EQ(a.bvhNodes()[i].max_x.x * float(scale), b.bvhNodes()[i].max_x.x) << i << " scale " << scale;
        }
        ASSERT_EQ(a.lights().size(), b.lights().size()) << scale;
        for (size_t i = 0; i < a.lights().size(); ++i)
            EXPECT_EQ(a.lights()[i].pmf, b.lights()[i].pmf) << i << " scale " << scale;
    }
}

/// With a power of two for a scale every quantity of the copy is exact, so that packages in their own units are equal.
TEST(WorldFrame, BeyondThatTheUnitChangesWithAWarningAndThePictureStays)
{
    const Result<Made> reference = make(site({0, 0, 0}, 0x1p-40));
    ASSERT_TRUE(reference) << reference.error().message;
    const Result<Made> ordinary = make(site({0, 0, 0}));
    ASSERT_TRUE(ordinary) << ordinary.error().message;
    const double unit =
        reference->package.meta().unit() * 0x1p40; // the size that units make 1, of the scene at scale 1
    EXPECT_GE(unit, 1);
    EXPECT_LE(unit, 2);
    for (const double scale : {0x1p-40, 0x1p-20, 0x1p20, 0x1p40})
    {
        const Result<Made> made = make(site({0, 0, 0}, scale));
        ASSERT_TRUE(made) << made.error().message;
        EXPECT_EQ(made->package.meta().unit(), unit * scale) << scale;
        EXPECT_EQ(warningsAbout(made->report, "units of"), 1u) << scale;
        expectSamePicture(made->package, reference->package);
        const double power = made->report.meta.statistics->total_light_power; // watts are W/m^2 times areas
        EXPECT_NEAR(power, ordinary->report.meta.statistics->total_light_power * scale * scale, power * 1e-6) << scale;
    }
    // Against the scene in metres: irradiance and absorption by what they do over a distance, radiance as it is.
    const auto& a = ordinary->package;
    const auto& b = reference->package;
    ASSERT_EQ(a.lights().size(), b.lights().size());
    for (size_t i = 0; i < a.lights().size(); ++i)
    {
        const bool local = a.lights()[i].kind <= gpu::kLightSpot;
        EXPECT_FLOAT_EQ(a.lights()[i].emission.x, b.lights()[i].emission.x * float(local ? unit * unit : 1)) << i;
        EXPECT_FLOAT_EQ(a.lights()[i].pmf, b.lights()[i].pmf) << i;
    }
    EXPECT_FLOAT_EQ(a.materials()[2].absorption.x, b.materials()[2].absorption.x / float(unit));
    EXPECT_GT(a.materials()[2].absorption.x, 0);
    EXPECT_FLOAT_EQ(a.meta().cameras()->Get(1)->orthographic_height(),
                    b.meta().cameras()->Get(1)->orthographic_height() * float(unit));
}

TEST(WorldFrame, ASmallSceneFarAwayIsBothMovedAndScaled)
{
    const Result<Made> made = make(site({3.5, 0, -1}, 0x1p-20));
    const Result<Made> local = make(site({0, 0, 0}, 0x1p-20));
    ASSERT_TRUE(made && local);
    const lumicut::fb::Vec3d* const origin = made->package.meta().origin();
    ASSERT_NE(origin, nullptr);
    EXPECT_EQ(Place({origin->x(), origin->y(), origin->z()}), Place({3.5, 0, -1}));
    expectSamePicture(made->package, local->package);
}

TEST(WorldFrame, LightsAndCamerasBeyondSinglePrecisionAreLeftOut)
{
    for (const char* key : {"camera", "extensions"})
    {
        GltfBuilder builder = site({0, 0, 0});
        builder.json["nodes"].push_back({{"name", "gone"}, {"translation", {1e39, 0, 0}}});
        builder.json["nodes"].back()[key] = key == std::string("camera")
                                                ? nlohmann::json(0)
                                                : nlohmann::json({{"KHR_lights_punctual", {{"light", 0}}}});
        builder.json["scenes"][0]["nodes"].push_back(builder.json["nodes"].size() - 1);
        const Result<Made> made = make(builder);
        ASSERT_TRUE(made) << key << ": " << made.error().message;
        EXPECT_EQ(warningsAbout(made->report, "beyond the range of numbers"), 1u) << key;
    }
}
} // namespace
