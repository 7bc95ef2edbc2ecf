// Scales that go through 0: what is mirrored has its front, its normals and its tangents where a scene compiled at that time has.
#include "compiler/compile.h"
#include "runtime/stages/pose.h"
#include "tests/compiler/gltf_builder.h"
#include "tests/compiler/posed_package.h"
#include "tests/stages/gi_test.h"
#include "tools/compare/welch.h"

namespace
{
using nlohmann::json;

constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedByte = 5121;

/// Over two seconds a sheet with a normal map is mirrored and, later, mirrored back; a lamp that shines on one side is; a glass
/// block, mirrored at rest, is no longer; and the upper joint of a strip is.
class MirroringScene
{
public:
    MirroringScene()
    {
        const int bumpy = gltf_.material({{"normalTexture", {{"index", gltf_.texture(2, 2, texels())}}}});
        const int white = gltf_.material({{"doubleSided", true}});
        const int lamp = gltf_.material({{"emissiveFactor", {1, 1, 1}}});
        const int glass = gltf_.material({{"extensions",
                                           {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                            {"KHR_materials_volume", {{"thicknessFactor", 0.1}}}}},
                                          {"pbrMetallicRoughness", {{"roughnessFactor", 0}}}});
        gltf_.node({{"mesh", gltf_.mesh(quads({-3, 0, 3, 3, 0, 3, 3, 0, -3, -3, 0, -3}, white))}});
        add(quads({-1.5f, 0.3f, 0, -0.5f, 0.3f, 0.3f, -0.5f, 1.3f, 0.3f, -1.5f, 1.3f, 0}, bumpy), {1, 1, 1},
            {1, 1, 1, -1, 1, 1, -1, -1, 1});
        add(quads({-0.3f, 2, -0.3f, 0.3f, 2, -0.3f, 0.3f, 2, 0.3f, -0.3f, 2, 0.3f}, lamp), {1, 1, 1},
            {1, 1, 1, 1, 0.9f, -1, 1, 0.8f, -1});
        add(quads({0.6f, 0.1f, 0,     1.2f, 0.1f, 0,     1.2f, 0.7f, 0,     0.6f, 0.7f, 0, //
                   1.2f, 0.1f, -0.3f, 0.6f, 0.1f, -0.3f, 0.6f, 0.7f, -0.3f, 1.2f, 0.7f, -0.3f},
                  glass),
            {1, 1, -1}, {1, 1, -1, 1, 1, 1, 1, 1, 1});
        addStrip(white);
        gltf_.json["scenes"][0]["nodes"] = roots_;
        gltf_.json["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_volume"};
        gltf_.writeGltf(source_);
        compileTo(package(), {});
    }

    std::filesystem::path package() const { return folder_ / "mirroring.lumi"; }
    std::filesystem::path bakedAt(double seconds) const
    {
        compileTo(folder_ / "baked.lumi", BakedTime{seconds, {}});
        return folder_ / "baked.lumi";
    }

private:
    /// A bump, and its inverse.
    static std::vector<uint8_t> texels()
    {
        return {200, 128, 230, 255, 60, 128, 230, 255, 128, 200, 230, 255, 128, 60, 230, 255};
    }

    json quads(const std::vector<float>& corners, int material)
    {
        std::vector<uint16_t> indices;
        std::vector<float> uvs;
        for (uint16_t q = 0; q < corners.size() / 12; ++q)
        {
            for (const int i : {0, 1, 2, 0, 2, 3})
                indices.push_back(uint16_t(4 * q + i));
            uvs.insert(uvs.end(), {0, 1, 1, 1, 1, 0, 0, 0});
        }
        return {{"attributes",
                 {{"POSITION", gltf_.positions(corners)},
                  {"TEXCOORD_0", gltf_.accessor(uvs, "VEC2", kFloat, uvs.size() / 2)}}},
                {"indices", gltf_.accessor(indices, "SCALAR", kUnsignedShort, indices.size())},
                {"material", material}};
    }

    void add(const json& primitive, const std::vector<float>& rest, const std::vector<float>& scales)
    {
        roots_.push_back(gltf_.node({{"mesh", gltf_.mesh(primitive)}, {"scale", rest}}));
        animate(roots_.back(), scales);
    }

    void animate(int node, const std::vector<float>& scales)
    {
        json& animation = gltf_.json["animations"][0];
        const int times = gltf_.accessor<float>({0, 1, 2}, "SCALAR", kFloat, 3);
        gltf_.json["accessors"][size_t(times)]["min"] = {0};
        gltf_.json["accessors"][size_t(times)]["max"] = {2};
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", "scale"}}}});
        animation["samplers"].push_back({{"input", times}, {"output", gltf_.accessor(scales, "VEC3", kFloat, 3)}});
    }

    void addStrip(int material)
    {
        json primitive = quads({1.5f, 0,    -1, 2, 0,    -1, 2, 0.5f, -1, 1.5f, 0.5f, -1, //
                                1.5f, 0.5f, -1, 2, 0.5f, -1, 2, 1,    -1, 1.5f, 1,    -1},
                               material);
        std::vector<uint8_t> joints;
        std::vector<float> weights;
        for (const uint8_t joint : {0, 0, 0, 0, 1, 1, 1, 1})
        {
            joints.insert(joints.end(), {joint, 0, 0, 0});
            weights.insert(weights.end(), {1, 0, 0, 0});
        }
        primitive["attributes"]["JOINTS_0"] = gltf_.accessor(joints, "VEC4", kUnsignedByte, 8);
        primitive["attributes"]["WEIGHTS_0"] = gltf_.accessor(weights, "VEC4", kFloat, 8);
        const int lower = gltf_.node({{"name", "lower"}}), upper = gltf_.node({{"name", "upper"}});
        gltf_.json["skins"].push_back({{"joints", {lower, upper}}});
        const int strip = gltf_.node({{"mesh", gltf_.mesh(primitive)}, {"skin", 0}});
        roots_.insert(roots_.end(), {lower, upper, strip});
        animate(upper, {1, 1, 1, 1, 1, 1, 1, 1, -1});
    }

    void compileTo(const std::filesystem::path& output, std::optional<BakedTime> time) const
    {
        const auto report = compile({.input = source_, .output = output, .time = std::move(time)});
        check(bool(report), "the mirroring scene does not compile: {}", report ? "" : report.error().message);
    }

    GltfBuilder gltf_;
    std::vector<int> roots_{0};
    TemporaryFolder folder_;
    std::filesystem::path source_ = folder_ / "mirroring.gltf";
};

Vec3d octahedralToUnit(double x, double y)
{
    const double z = 1 - std::abs(x) - std::abs(y), fold = std::max(-z, 0.0);
    const Vec3d v{x + (x >= 0 ? -fold : fold), y + (y >= 0 ? -fold : fold), z};
    return v * (1 / length(v));
}

Vec3d unpackNormal(uint32_t bits)
{
    return octahedralToUnit(int16_t(bits & 0xffffu) / 32767.0, int16_t(bits >> 16) / 32767.0);
}

Vec3d unpackTangent(uint32_t bits)
{
    return octahedralToUnit(int16_t(bits & 0xffffu) / 32767.0, (int32_t(bits) >> 17) / 16383.0);
}

class Mirrored : public GiTest
{
protected:
    void show(SceneGpu& scene, PoseStage& stage, double seconds)
    {
        submit(scene, [&](Recorder& rec) { stage.record(rec, package::poseAt(*package_, 0, seconds)); });
    }
    std::vector<ImageF> pictures(const SceneGpu& scene, Mode mode)
    {
        const Camera camera{
            .name = {}, .position = {0, 1.6f, 4.5f}, .forward = {0, -0.2f, -0.98f}, .up = {0, 0.98f, -0.2f}};
        std::vector<ImageF> images;
        for (uint32_t seed = 0; seed < 6; ++seed)
        {
            const Picture picture = render(scene, camera, smallSettings(), 16, 48, 32, mode, seed);
            images.push_back({48, 32, {}});
            for (const gpu::vec3& pixel : picture.pixels)
                images.back().rgb.insert(images.back().rgb.end(), {pixel.x, pixel.y, pixel.z});
        }
        return images;
    }

    MirroringScene source_;
    Result<package::Package> package_ = package::Package::open(source_.package());
};

TEST_F(Mirrored, TrianglesHaveFrontsNormalsAndTangentsOfTheSceneBakedThen)
{
    ASSERT_TRUE(package_);
    const auto scene = load(source_.package());
    PoseStage stage(device(), *scene, *package_);
    uint32_t with_tangent = 0;
    for (const double seconds : {0.25, 0.75, 1.25, 1.75, 0.1})
    {
        show(*scene, stage, seconds);
        const auto baked = package::Package::open(source_.bakedAt(seconds));
        ASSERT_TRUE(baked);
        const size_t count = baked->triangles().size();
        ASSERT_EQ(count, package_->triangles().size());
        const auto triangles = device().download<gpu::Triangle>(scene->buffer(gpu::kTrianglesBinding), count);
        const auto slots = device().download<gpu::BvhTriangle>(scene->buffer(gpu::kBvhTrianglesBinding),
                                                               package_->bvhTriangles().size());
        const auto vertices = device().download<gpu::VertexAttributes>(scene->buffer(gpu::kVertexAttributesBinding),
                                                                       package_->vertexAttributes().size());
        for (const gpu::BvhTriangle& right : baked->bvhTriangles())
        {
            const auto found = std::ranges::find(slots, right.triangle, &gpu::BvhTriangle::triangle);
            ASSERT_NE(found, slots.end());
            const std::array corners{found->v0, found->v1, found->v2}, expected{right.v0, right.v1, right.v2};
            const gpu::uvec3 a = triangles[right.triangle].vertices, b = baked->triangles()[right.triangle].vertices;
            const std::array indices{a.x, a.y, a.z}, of_baked{b.x, b.y, b.z};
            for (size_t i = 0; i < 3; ++i)
            {
                // A dozen roundings of numbers below 4, as in the test of poses.
                EXPECT_LT(length(toDouble(corners[i]) - toDouble(expected[i])), 12 * 4 * std::ldexp(1.0, -24))
                    << seconds << " triangle " << right.triangle << " corner " << i;
                const gpu::VertexAttributes& is = vertices[indices[i]];
                const gpu::VertexAttributes& was = baked->vertexAttributes()[of_baked[i]];
                // Packing takes 3e-5 of a normal, 6e-5 of a tangent, here and there.
                EXPECT_LT(length(unpackNormal(is.normal) - unpackNormal(was.normal)), 6e-5)
                    << seconds << " triangle " << right.triangle << " corner " << i;
                EXPECT_EQ(is.uv0.x, was.uv0.x);
                EXPECT_EQ(is.uv0.y, was.uv0.y);
                if (was.tangent == 0)
                    continue;
                ++with_tangent;
                EXPECT_LT(length(unpackTangent(is.tangent) - unpackTangent(was.tangent)), 1.2e-4) << seconds;
                EXPECT_EQ(is.tangent & 0x10000u, was.tangent & 0x10000u) << seconds;
            }
        }
    }
    EXPECT_EQ(with_tangent, 5 * 6u);
}

TEST_F(Mirrored, CornersAreFoundWhereTheyWereAtAChange)
{
    ASSERT_TRUE(package_);
    const auto scene = load(source_.package());
    PoseStage stage(device(), *scene, *package_);
    const auto corners = [&]
    {
        std::vector<gpu::vec3> all(3 * package_->triangles().size());
        for (const gpu::BvhTriangle& t : device().download<gpu::BvhTriangle>(scene->buffer(gpu::kBvhTrianglesBinding),
                                                                             package_->bvhTriangles().size()))
            for (size_t i = 0; i < 3; ++i)
                all[3 * t.triangle + i] = i == 0 ? t.v0 : i == 1 ? t.v1 : t.v2;
        return all;
    };
    show(*scene, stage, 0.45);
    const auto before = corners();
    show(*scene, stage, 0.55); // the sheet, the lamp and the block have changed their sides by now
    const auto last = device().download<gpu::TriangleCorners>(scene->lastCorners(), package_->bvhTriangles().size() -
                                                                                        package_->firstMovingSlot());
    const auto slots =
        device().download<gpu::BvhTriangle>(scene->buffer(gpu::kBvhTrianglesBinding), package_->bvhTriangles().size());
    // A scale moves corners by a tenth of their distance from the middle of the world at most: 2 metres.
    for (size_t i = 0; i < last.size(); ++i)
    {
        const gpu::BvhTriangle& now = slots[package_->firstMovingSlot() + i];
        const std::array was{last[i].v0, last[i].v1, last[i].v2}, is{now.v0, now.v1, now.v2};
        for (size_t c = 0; c < 3; ++c)
            EXPECT_LT(length(toDouble(was[c]) - toDouble(is[c])), 0.41) << i << " " << c;
        EXPECT_EQ(was[0].x, before[3 * now.triangle].x);
    }
}

TEST_F(Mirrored, PicturesAreThoseOfTheSceneBakedThen)
{
    ASSERT_TRUE(package_);
    const auto scene = load(source_.package()), baked = load(source_.bakedAt(0.9));
    PoseStage stage(device(), *scene, *package_);
    show(*scene, stage, 0.9);
    for (const Mode mode : {Mode::kDirect, Mode::kReference})
    {
        const WelchResult result = welch(pictures(*scene, mode), pictures(*baked, mode));
        EXPECT_FALSE(result.differ()) << "mode " << int(mode) << ": p " << result.smallest.p << " of "
                                      << result.smallest.difference << " in tile " << result.smallest.tile_x << " "
                                      << result.smallest.tile_y;
    }
}
} // namespace
