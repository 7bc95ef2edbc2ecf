#include "compiler/gltf_scene.h"

#include "compiler/gltf_accessor.h"
#include "compiler/gltf_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace
{
Error invalid(std::string text)
{
    return {ExitCode::kInvalid, std::move(text)};
}

/// Local transforms of EXT_mesh_gpu_instancing, or the identity alone.
Result<std::vector<Transform>> instanceTransforms(const tinygltf::Model& model, const tinygltf::Node& node)
{
    const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
    if (extension == node.extensions.end())
        return std::vector<Transform>(1);
    const tinygltf::Value& attributes = extension->second.Get("attributes");
    const auto read = [&](const char* name, uint32_t components) -> Result<FloatArray>
    {
        if (!attributes.IsObject() || !attributes.Get(name).IsInt())
            return FloatArray{};
        return readFloats(model, attributes.Get(name).GetNumberAsInt(), components, components);
    };
    const auto t = read("TRANSLATION", 3);
    const auto r = read("ROTATION", 4);
    const auto s = read("SCALE", 3);
    for (const auto* array : {&t, &r, &s})
        if (!*array)
            return array->error();
    const size_t count = std::max({t->count, r->count, s->count});
    for (const auto* array : {&t, &r, &s})
        if ((*array)->count != 0 && (*array)->count != count)
            return invalid("instance attributes have different numbers of elements");
    std::vector<Transform> transforms(count);
    for (size_t i = 0; i < count; ++i)
    {
        const auto at = [i](const FloatArray& a, uint32_t c, double fallback)
        { return a.count == 0 ? fallback : double(a.values[i * a.components + c]); };
        transforms[i] = fromTranslationRotationScale({at(*t, 0, 0), at(*t, 1, 0), at(*t, 2, 0)},
                                                     {at(*r, 0, 0), at(*r, 1, 0), at(*r, 2, 0), at(*r, 3, 1)},
                                                     {at(*s, 0, 1), at(*s, 1, 1), at(*s, 2, 1)});
        if (!isFiniteTransform(transforms[i]))
            return invalid("an instance's transform is not finite");
    }
    return transforms;
}

PunctualLight makeLight(const tinygltf::Light& from, const Transform& to_world)
{
    PunctualLight light;
    light.kind = from.type == "spot"          ? gpu::kLightSpot
                 : from.type == "directional" ? gpu::kLightDirectional
                                              : gpu::kLightPoint;
    light.position = to_world.point({});
    light.direction = directionOr(to_world.vector({0, 0, -1}), {0, 0, -1});
    const bool colored = from.color.size() == 3;
    const auto channel = [&](size_t i) { return float((colored ? from.color[i] : 1.0) * from.intensity); };
    light.intensity = {channel(0), channel(1), channel(2)};
    if (light.kind == gpu::kLightSpot)
    {
        light.inner_cone = float(from.spot.innerConeAngle);
        light.outer_cone = float(from.spot.outerConeAngle);
    }
    return light;
}

CameraView makeCamera(const tinygltf::Camera& from, const tinygltf::Node& node, const Transform& to_world, int index)
{
    constexpr double kWidest = 3.14; // radians: of pi itself there is no picture
    CameraView view;
    view.name = !node.name.empty() ? node.name : !from.name.empty() ? from.name : fmt::format("camera {}", index);
    view.position = to_world.point({});
    view.forward = directionOr(to_world.vector({0, 0, -1}), {0, 0, -1});
    const Vec3d forward = toDouble(view.forward);
    const Vec3d up = unitOrZero(to_world.vector({0, 1, 0}));
    view.up = directionOr(up - forward * dot(up, forward), anyOrthogonal(view.forward));
    if (from.type == "orthographic")
        view.orthographic_height = float(2 * from.orthographic.ymag);
    else
        view.vertical_fov = float(std::min(from.perspective.yfov, kWidest));
    view.near_plane = float(from.type == "orthographic" ? from.orthographic.znear : from.perspective.znear);
    view.far_plane = float(from.type == "orthographic" ? from.orthographic.zfar : from.perspective.zfar);
    return view;
}

/// Those of the node, else of its mesh; empty where none differs from 0.
std::vector<double> morphWeights(const tinygltf::Mesh& mesh, const tinygltf::Node& node)
{
    std::vector<double> weights = node.weights.empty() ? mesh.weights : node.weights;
    while (!weights.empty() && weights.back() == 0)
        weights.pop_back();
    return weights;
}

/// Of a model that repairGltf() has seen: indices are in range, and every node is reached once.
class Walk
{
public:
    Walk(const tinygltf::Model& model, const std::vector<bool>& may_show) : model_(model), may_show_(may_show) {}

    SceneNodes run(const std::vector<int>& roots)
    {
        std::vector<Pending> stack;
        push(roots, Transform{}, false, stack);
        while (!stack.empty())
        {
            const Pending next = stack.back();
            stack.pop_back();
            visit(next, stack);
        }
        return std::move(nodes_);
    }

private:
    struct Pending
    {
        size_t node;
        Transform parent;
        bool hidden;
    };

    static void push(const std::vector<int>& children, const Transform& parent, bool hidden,
                     std::vector<Pending>& stack)
    {
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            stack.push_back({size_t(*child), parent, hidden});
    }

    /// Says what is wrong with a node.
    void leaveOut(const Error& error, size_t node, const char* stand_in)
    {
        nodes_.warnings.push_back(
            warningOf(WarningKind::kBadGeometry, error, fmt::format("/nodes/{}", node), stand_in));
    }

    void visit(const Pending& pending, std::vector<Pending>& stack)
    {
        const tinygltf::Node& node = model_.nodes[pending.node];
        const auto visibility = node.extensions.find("KHR_node_visibility");
        const bool hides = visibility != node.extensions.end() && visibility->second.Get("visible").IsBool() &&
                           !visibility->second.Get("visible").Get<bool>(); // the whole subtree
        if (hides && (may_show_.empty() || !may_show_[pending.node]))
            return;
        const bool hidden = pending.hidden || hides;
        const Result<Transform> local = localTransform(node, pending.node);
        if (!local || !isFiniteTransform(pending.parent * *local))
            return leaveOut(local ? invalid("a node's place is beyond the range of numbers") : local.error(),
                            pending.node, "the node and its children are left out");
        const Transform to_world = pending.parent * *local;
        addMesh(node, pending.node, to_world, hidden);
        if (isFinite(toFloat(to_world.point({}))))
        {
            addCamera(node, pending.node, to_world);
            addLight(node, pending.node, to_world, hidden);
        }
        else if (node.camera != -1 || node.extensions.contains("KHR_lights_punctual"))
            leaveOut(invalid("a camera or a light is beyond the range of numbers"), pending.node, "it is left out");
        push(node.children, to_world, hidden, stack);
    }

    void addMesh(const tinygltf::Node& node, size_t index, const Transform& to_world, bool hidden)
    {
        if (node.mesh == -1)
            return;
        const auto instances = instanceTransforms(model_, node);
        if (!instances)
            return leaveOut(instances.error(), index, "its mesh is left out");
        std::vector<double> weights = morphWeights(model_.meshes[size_t(node.mesh)], node);
        if (node.skin != -1) // its joints place it, wherever its node or instances of it are
        {
            nodes_.meshes.push_back({node.mesh, to_world, node.skin, std::move(weights), index, {}, hidden});
            return;
        }
        for (const Transform& instance : *instances)
            nodes_.meshes.push_back({node.mesh, to_world * instance, -1, weights, index, instance, hidden});
    }

    void addCamera(const tinygltf::Node& node, size_t index, const Transform& to_world)
    {
        if (node.camera == -1)
            return;
        nodes_.cameras.push_back(makeCamera(model_.cameras[size_t(node.camera)], node, to_world, node.camera));
        nodes_.camera_nodes.push_back(index);
    }

    void addLight(const tinygltf::Node& node, size_t index, const Transform& to_world, bool hidden)
    {
        const int light = lightOf(node);
        if (light == -1)
            return;
        nodes_.lights.push_back(makeLight(model_.lights[size_t(light)], to_world));
        nodes_.light_nodes.push_back(index);
        if (hidden)
            nodes_.lights.back().intensity = {};
    }

    const tinygltf::Model& model_;
    const std::vector<bool>& may_show_;
    SceneNodes nodes_;
};

/// The scene of that name or index; if `wanted` is empty the file's default, without one its first.
Result<size_t> chooseScene(const tinygltf::Model& model, const std::string& wanted)
{
    if (wanted.empty())
        return size_t(model.defaultScene == -1 ? 0 : model.defaultScene);
    for (size_t i = 0; i < model.scenes.size(); ++i)
        if (model.scenes[i].name == wanted)
            return i;
    size_t index = 0;
    const char* const end = wanted.data() + wanted.size();
    const auto [stop, failure] = std::from_chars(wanted.data(), end, index);
    if (failure == std::errc() && stop == end && index < model.scenes.size())
        return index;
    std::string names;
    for (size_t i = 0; i < model.scenes.size(); ++i)
        names += fmt::format("{}\"{}\" ({})", i == 0 ? "" : ", ", model.scenes[i].name, i);
    return Error{ExitCode::kUsage, fmt::format("there is no scene \"{}\"; the file has {}", wanted, names)};
}

/// Nodes that are below no other.
std::vector<int> rootNodes(const tinygltf::Model& model)
{
    std::vector<bool> below(model.nodes.size());
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children)
            below[size_t(child)] = true;
    std::vector<int> roots;
    for (size_t i = 0; i < below.size(); ++i)
        if (!below[i])
            roots.push_back(int(i));
    return roots;
}
} // namespace

int lightOf(const tinygltf::Node& node)
{
    const auto extension = node.extensions.find("KHR_lights_punctual");
    return extension == node.extensions.end() ? -1 : extension->second.Get("light").GetNumberAsInt();
}

Result<SceneNodes> walkScene(const tinygltf::Model& model, const std::string& wanted, const std::vector<bool>& may_show)
{
    if (model.scenes.empty())
    {
        const std::vector<int> roots = rootNodes(model);
        if (roots.empty())
            return Error{ExitCode::kInvalid, "it has no scene and no node, so there is nothing to compile (/scenes)"};
        if (!wanted.empty())
            return Error{ExitCode::kUsage, fmt::format("there is no scene \"{}\"; the file has none", wanted)};
        SceneNodes nodes = Walk(model, may_show).run(roots);
        nodes.warnings.push_back("the file has no scene; all its nodes are compiled");
        return nodes;
    }
    const Result<size_t> scene = chooseScene(model, wanted);
    if (!scene)
        return scene.error();
    SceneNodes nodes = Walk(model, may_show).run(model.scenes[*scene].nodes);
    if (wanted.empty() && model.defaultScene == -1 && model.scenes.size() > 1)
        nodes.warnings.push_back(fmt::format(
            "the file names no default scene; the first of {} is compiled (--scene chooses)", model.scenes.size()));
    return nodes;
}
