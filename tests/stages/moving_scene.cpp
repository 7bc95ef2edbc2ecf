#include "tests/stages/moving_scene.h"

#include "compiler/compile.h"
#include "format/check.h"
#include "tests/compiler/gltf_builder.h"

#include <cmath>
#include <numbers>

namespace
{
using nlohmann::json;

constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedByte = 5121;

class Builder
{
public:
    /// A mesh of quads: four corners each, counter-clockwise.
    json quads(const std::vector<float>& corners, int material)
    {
        std::vector<uint16_t> indices;
        for (uint16_t q = 0; q < corners.size() / 12; ++q)
            for (const int i : {0, 1, 2, 0, 2, 3})
                indices.push_back(uint16_t(4 * q + i));
        return {{"attributes", {{"POSITION", gltf.positions(corners)}}},
                {"indices", gltf.accessor(indices, "SCALAR", kUnsignedShort, indices.size())},
                {"material", material}};
    }

    int box(float side, int material)
    {
        const float a = -side / 2, b = side / 2;
        return gltf.mesh(quads({a, a, b, b, a, b, b, b, b, a, b, b, b, a, a, a, a, a, a, b, a, b, b, a, //
                                a, b, b, b, b, b, b, b, a, a, b, a, a, a, a, b, a, a, b, a, b, a, a, b, //
                                b, a, b, b, a, a, b, b, a, b, b, b, a, a, a, a, a, b, a, b, b, a, b, a},
                               material));
    }

    int sphere(float radius, int n, int material)
    {
        std::vector<float> corners;
        const auto corner = [&](int i, int j)
        {
            const double theta = std::numbers::pi * i / n, phi = std::numbers::pi * j / n;
            for (const double x : {std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi)})
                corners.push_back(float(radius * x));
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < 2 * n; ++j)
                for (const auto& [k, l] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}})
                    corner(k, l);
        return gltf.mesh(quads(corners, material));
    }

    /// Keys at seconds 0, 1 and 2.
    void channel(json target, const std::vector<float>& values, const char* type, const char* interpolation = "LINEAR")
    {
        json& animation = gltf.json["animations"][0];
        animation["name"] = "all";
        animation["samplers"].push_back({{"input", times()},
                                         {"interpolation", interpolation},
                                         {"output", gltf.accessor(values, type, kFloat, countOf(values, type))}});
        animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1}, {"target", std::move(target)}});
    }

    int skinnedStrip(int material)
    {
        const std::vector<float> corners{-0.2f, 0,    0, 0.2f, 0,    0, 0.2f, 0.5f, 0, -0.2f, 0.5f, 0,
                                         -0.2f, 0.5f, 0, 0.2f, 0.5f, 0, 0.2f, 1,    0, -0.2f, 1,    0};
        json primitive = quads(corners, material);
        std::vector<uint8_t> joints;
        std::vector<float> weights;
        for (size_t v = 0; v < corners.size() / 3; ++v)
        {
            joints.insert(joints.end(), {0, 1, 0, 0});
            const float upper = corners[3 * v + 1]; // of joint 1, at half the height
            weights.insert(weights.end(), {1 - upper, upper, 0, 0});
        }
        primitive["attributes"]["JOINTS_0"] = gltf.accessor(joints, "VEC4", kUnsignedByte, joints.size() / 4);
        primitive["attributes"]["WEIGHTS_0"] = gltf.accessor(weights, "VEC4", kFloat, weights.size() / 4);
        return gltf.mesh(primitive);
    }

    int morphedSheet(int material)
    {
        const std::vector<float> corners{-0.4f, -0.4f, 0, 0.4f, -0.4f, 0, 0.4f, 0.4f, 0, -0.4f, 0.4f, 0};
        json primitive = quads(corners, material);
        primitive["targets"] =
            json::array({{{"POSITION", gltf.positions({0, 0, 0.5f, 0, 0, 0, 0, 0, 0.25f, 0.1f, 0, 0})}}});
        return gltf.mesh(primitive);
    }

    GltfBuilder gltf;

private:
    int times()
    {
        if (times_ < 0)
            times_ = gltf.accessor<float>({0, 1, 2}, "SCALAR", kFloat, 3);
        gltf.json["accessors"][size_t(times_)]["min"] = {0};
        gltf.json["accessors"][size_t(times_)]["max"] = {2};
        return times_;
    }
    static size_t countOf(const std::vector<float>& values, const std::string& type)
    {
        return values.size() / (type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4);
    }
    int times_ = -1;
};

json node(int node, const char* path)
{
    return {{"node", node}, {"path", path}};
}

json pointer(const std::string& property)
{
    return {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", property}}}}}};
}
} // namespace

struct MovingScene::Folder
{
    TemporaryFolder folder;
};

MovingScene::~MovingScene() = default;

MovingScene::MovingScene() : folder_(std::make_unique<Folder>())
{
    Builder b;
    GltfBuilder& gltf = b.gltf;
    const int white = gltf.material({{"pbrMetallicRoughness", {{"metallicFactor", 0}}}, {"doubleSided", true}});
    const int shining = gltf.material({{"emissiveFactor", {1, 1, 1}}});
    const int mirror = gltf.material({{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}}});
    const float h = std::sqrt(0.5f);

    gltf.node({{"mesh", gltf.mesh(b.quads({-3, 0, 3, 3, 0, 3, 3, 0, -3, -3, 0, -3}, white))}});
    const int box =
        gltf.node({{"mesh", b.box(0.6f, white)}, {"translation", {-1, 0.5f, 0}}, {"scale", {1, 1.5f, 0.8f}}});
    b.channel(node(box, "rotation"), {0, 0, 0, 1, 0, h, 0, h, 0, 1, 0, 0}, "VEC4");
    b.channel(node(box, "translation"), {-1, 0.5f, 0, -1.2f, 0.8f, 0.4f, -0.5f, 0.6f, 1}, "VEC3");

    const int lower = gltf.node({{"translation", {0.5f, 0, 0}}});
    const int upper = gltf.node({{"translation", {0, 0.5f, 0}}});
    gltf.json["nodes"][size_t(lower)]["children"] = {upper};
    const std::vector<float> bind{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,     0, 1, //
                                  1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.5f, 0, 1};
    gltf.json["skins"].push_back(
        {{"joints", {lower, upper}}, {"inverseBindMatrices", gltf.accessor(bind, "MAT4", kFloat, 2)}});
    gltf.node({{"mesh", b.skinnedStrip(white)}, {"skin", 0}});
    b.channel(node(upper, "rotation"), {0, 0, 0, 1, h, 0, 0, h, 0, 0, h, h}, "VEC4");

    const int sheet = gltf.node({{"mesh", b.morphedSheet(white)}, {"translation", {1.5f, 0.6f, -0.5f}}});
    b.channel(node(sheet, "weights"), {0, 1, 0.5f}, "SCALAR");

    const int lamp = gltf.node(
        {{"mesh", gltf.mesh(b.quads({-0.2f, 0, -0.2f, 0.2f, 0, -0.2f, 0.2f, 0, 0.2f, -0.2f, 0, 0.2f}, shining))},
         {"translation", {0, 2, 0}}});
    b.channel(node(lamp, "translation"), {0, 2, 0, 0.3f, 2.3f, 0.2f, 0, 2.6f, 0.4f}, "VEC3");
    b.channel(node(lamp, "scale"), {1, 1, 1, 1.5f, 1, 1.2f, 0.5f, 1, 0.4f}, "VEC3");

    // Dark at rest.
    const int glowing = gltf.material({{"emissiveFactor", {0, 0, 0}}});
    gltf.node({{"mesh", gltf.mesh(b.quads({-2, 0, -1, -1.2f, 0, -1, -1.2f, 0.8f, -1, -2, 0.8f, -1}, glowing))}});
    b.channel(pointer("/materials/" + std::to_string(glowing) + "/emissiveFactor"), {0, 0, 0, 1, 0.8f, 0.4f, 1, 1, 1},
              "VEC3");
    b.channel(pointer("/extensions/KHR_lights_punctual/lights/1/intensity"), {0, 5, 0}, "SCALAR");

    const int hidden = gltf.node({{"mesh", b.box(0.4f, white)},
                                  {"translation", {0, 0.3f, -1.5f}},
                                  {"scale", {-1, 1, 1}},
                                  {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
    b.channel(pointer("/nodes/" + std::to_string(hidden) + "/extensions/KHR_node_visibility/visible"), {1, 0, 0},
              "SCALAR", "STEP");

    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"intensity", 20}, {"spot", {{"outerConeAngle", 0.6f}}}},
        {{"type", "point"}, {"intensity", 0}}};
    gltf.node({{"translation", {-1, 1.5f, 1.5f}}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    const int spot = gltf.node({{"translation", {1, 2.5f, 1}},
                                {"rotation", {-h, 0, 0, h}},
                                {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    b.channel(node(spot, "rotation"), {-h, 0, 0, h, -0.6f, 0, 0, 0.8f, -h, 0, 0, h}, "VEC4");

    const int ball = gltf.node({{"mesh", b.sphere(0.3f, 8, mirror)}, {"translation", {0.5f, 0.3f, 1}}});
    b.channel(node(ball, "translation"), {0.5f, 0.3f, 1, 1, 0.3f, 1.2f, 1.5f, 0.3f, 1}, "VEC3");

    gltf.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_node_visibility", "KHR_animation_pointer"};
    json roots = json::array();
    for (size_t i = 0; i < gltf.json["nodes"].size(); ++i)
        if (int(i) != upper)
            roots.push_back(i);
    gltf.json["scenes"][0]["nodes"] = roots;
    source_ = folder_->folder / "moving.gltf";
    package_ = folder_->folder / "moving.lumi";
    gltf.writeGltf(source_);
    compileSource();
}

MovingScene::MovingScene(std::span<const uint8_t> glb)
    : folder_(std::make_unique<Folder>()), source_(folder_->folder / "moving.glb"),
      package_(folder_->folder / "moving.lumi")
{
    writeBytes(source_, glb.data(), glb.size());
    compileSource();
}

void MovingScene::compileSource() const
{
    const auto report = compile({.input = source_, .output = package_});
    check(bool(report), "the moving scene does not compile: {}", report ? "" : report.error().message);
}

std::filesystem::path MovingScene::bakedAt(double seconds) const
{
    const std::filesystem::path package = folder_->folder / "baked.lumi";
    const auto report = compile({.input = source_, .output = package, .time = BakedTime{seconds, {}}});
    check(bool(report), "the moving scene cannot be baked: {}", report ? "" : report.error().message);
    return package;
}
