#include "compiler/gltf_scene.h"

#include "compiler/gltf_accessor.h"
#include "compiler/gltf_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace
{
Error invalid(std::string_view text, size_t node)
{
    return {ExitCode::kInvalid, fmt::format("{} (/nodes/{})", text, node)};
}

/// Local transforms of EXT_mesh_gpu_instancing, or the identity alone.
Result<std::vector<Transform>> instanceTransforms(const tinygltf::Model& model, const tinygltf::Node& node,
                                                  size_t index)
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
            return invalid(array->error().message, index);
    const size_t count = std::max({t->count, r->count, s->count});
    for (const auto* array : {&t, &r, &s})
        if ((*array)->count != 0 && (*array)->count != count)
            return invalid("instance attributes have different numbers of elements", index);
    std::vector<Transform> transforms(count);
    for (size_t i = 0; i < count; ++i)
    {
        const auto at = [i](const FloatArray& a, uint32_t c, double fallback)
        { return a.count == 0 ? fallback : double(a.values[i * a.components + c]); };
        transforms[i] = fromTranslationRotationScale({at(*t, 0, 0), at(*t, 1, 0), at(*t, 2, 0)},
                                                     {at(*r, 0, 0), at(*r, 1, 0), at(*r, 2, 0), at(*r, 3, 1)},
                                                     {at(*s, 0, 1), at(*s, 1, 1), at(*s, 2, 1)});
        if (!isFiniteTransform(transforms[i]))
            return invalid("an instance's transform is not finite", index);
    }
    return transforms;
}

Result<PunctualLight> makeLight(const tinygltf::Light& from, const Transform& to_world, int index)
{
    const auto bad = [&](std::string_view text) {
        return Error{ExitCode::kInvalid, fmt::format("{} (/extensions/KHR_lights_punctual/lights/{})", text, index)};
    };
    PunctualLight light;
    if (from.type == "point")
        light.kind = gpu::kLightPoint;
    else if (from.type == "spot")
        light.kind = gpu::kLightSpot;
    else if (from.type == "directional")
        light.kind = gpu::kLightDirectional;
    else
        return bad(fmt::format("light type \"{}\" does not exist", from.type.substr(0, 40)));
    light.position = to_world.point({});
    light.direction = directionOr(to_world.vector({0, 0, -1}), {0, 0, -1});
    const bool colored = from.color.size() == 3;
    const auto channel = [&](size_t i)
    { return float(std::max((colored ? from.color[i] : 1.0) * from.intensity, 0.0)); };
    light.intensity = {channel(0), channel(1), channel(2)};
    if (!isFinite(light.intensity))
        return bad("a light's intensity is not finite");
    if (light.kind == gpu::kLightSpot)
    {
        light.inner_cone = float(from.spot.innerConeAngle);
        light.outer_cone = float(from.spot.outerConeAngle);
        if (!(light.inner_cone >= 0) || !(light.outer_cone <= 1.5708f) || !(light.inner_cone <= light.outer_cone))
            return bad("a spot's cone angles must be 0 <= inner <= outer <= pi/2");
    }
    return light;
}

Result<CameraView> makeCamera(const tinygltf::Camera& from, const tinygltf::Node& node, const Transform& to_world,
                              int index)
{
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
        view.vertical_fov = float(from.perspective.yfov);
    view.near_plane = float(from.type == "orthographic" ? from.orthographic.znear : from.perspective.znear);
    view.far_plane = float(from.type == "orthographic" ? from.orthographic.zfar : from.perspective.zfar);
    const bool good = from.type == "orthographic"
                          ? view.orthographic_height > 0 && std::isfinite(view.orthographic_height)
                          : view.vertical_fov > 0 && view.vertical_fov < 3.1415f;
    if (!good)
        return Error{ExitCode::kInvalid, fmt::format("a camera has no usable field of view (/cameras/{})", index)};
    if (!(view.near_plane >= 0) || !std::isfinite(view.near_plane) || !std::isfinite(view.far_plane) ||
        (view.far_plane != 0 && !(view.far_plane > view.near_plane)))
        return Error{ExitCode::kInvalid, fmt::format("a camera's planes znear and zfar must be 0 <= znear < zfar "
                                                     "(/cameras/{})",
                                                     index)};
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

class Walk
{
public:
    explicit Walk(const tinygltf::Model& model) : model_(model), visited_(model.nodes.size(), false) {}

    Result<SceneNodes> run(const std::vector<int>& roots)
    {
        std::vector<Pending> stack;
        if (const Status status = push(roots, Transform{}, stack); !status)
            return status.error();
        while (!stack.empty())
        {
            const Pending next = stack.back();
            stack.pop_back();
            if (const Status status = visit(next, stack); !status)
                return status.error();
        }
        return std::move(nodes_);
    }

private:
    struct Pending
    {
        size_t node;
        Transform parent;
    };

    /// Marks nodes as reached when they are pushed, so that a cycle ends at once.
    Status push(const std::vector<int>& children, const Transform& parent, std::vector<Pending>& stack)
    {
        for (auto child = children.rbegin(); child != children.rend(); ++child)
        {
            if (*child < 0 || size_t(*child) >= model_.nodes.size())
                return Error{ExitCode::kInvalid, fmt::format("node {} does not exist", *child)};
            if (visited_[size_t(*child)])
                return invalid("a node is reached twice: it has two parents or is its own ancestor", size_t(*child));
            visited_[size_t(*child)] = true;
            stack.push_back({size_t(*child), parent});
        }
        return Success{};
    }

    Status visit(const Pending& pending, std::vector<Pending>& stack)
    {
        const tinygltf::Node& node = model_.nodes[pending.node];
        const auto visibility = node.extensions.find("KHR_node_visibility");
        if (visibility != node.extensions.end() && visibility->second.Get("visible").IsBool() &&
            !visibility->second.Get("visible").Get<bool>())
            return Success{}; // hides the whole subtree
        const Result<Transform> local = localTransform(node, pending.node);
        if (!local)
            return local.error();
        const Transform to_world = pending.parent * *local;
        if (const Status status = addMesh(node, pending.node, to_world); !status)
            return status;
        if (const Status status = addCamera(node, pending.node, to_world); !status)
            return status;
        if (const Status status = addLight(node, pending.node, to_world); !status)
            return status;
        return push(node.children, to_world, stack);
    }

    Status addMesh(const tinygltf::Node& node, size_t index, const Transform& to_world)
    {
        if (node.mesh == -1)
            return Success{};
        if (node.mesh < 0 || size_t(node.mesh) >= model_.meshes.size())
            return invalid(fmt::format("mesh {} does not exist", node.mesh), index);
        const auto instances = instanceTransforms(model_, node, index);
        if (!instances)
            return instances.error();
        std::vector<double> weights = morphWeights(model_.meshes[size_t(node.mesh)], node);
        if (node.skin != -1) // its joints place it, wherever its node or instances of it are
        {
            nodes_.meshes.push_back({node.mesh, to_world, node.skin, std::move(weights)});
            return Success{};
        }
        for (const Transform& instance : *instances)
            nodes_.meshes.push_back({node.mesh, to_world * instance, -1, weights});
        return Success{};
    }

    Status addCamera(const tinygltf::Node& node, size_t index, const Transform& to_world)
    {
        if (node.camera == -1)
            return Success{};
        if (node.camera < 0 || size_t(node.camera) >= model_.cameras.size())
            return invalid(fmt::format("camera {} does not exist", node.camera), index);
        Result<CameraView> view = makeCamera(model_.cameras[size_t(node.camera)], node, to_world, node.camera);
        if (!view)
            return view.error();
        nodes_.cameras.push_back(std::move(*view));
        return Success{};
    }

    Status addLight(const tinygltf::Node& node, size_t index, const Transform& to_world)
    {
        const auto extension = node.extensions.find("KHR_lights_punctual");
        if (extension == node.extensions.end())
            return Success{};
        const tinygltf::Value& reference = extension->second.Get("light");
        const int light = reference.IsInt() ? reference.GetNumberAsInt() : -1;
        if (light < 0 || size_t(light) >= model_.lights.size())
            return invalid("a node names a light that does not exist", index);
        const Result<PunctualLight> made = makeLight(model_.lights[size_t(light)], to_world, light);
        if (!made)
            return made.error();
        nodes_.lights.push_back(*made);
        return Success{};
    }

    const tinygltf::Model& model_;
    std::vector<bool> visited_;
    SceneNodes nodes_;
};
/// The scene that `wanted` names or numbers; where it is empty the file's default, else its first.
Result<size_t> chooseScene(const tinygltf::Model& model, const std::string& wanted)
{
    if (model.scenes.empty())
        return Error{ExitCode::kInvalid, "it has no scene, so there is nothing to compile (/scenes)"};
    if (wanted.empty())
    {
        const int scene = model.defaultScene == -1 ? 0 : model.defaultScene;
        if (scene < 0 || size_t(scene) >= model.scenes.size())
            return Error{ExitCode::kInvalid, fmt::format("scene {} does not exist (/scene)", scene)};
        return size_t(scene);
    }
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
} // namespace

Result<SceneNodes> walkScene(const tinygltf::Model& model, const std::string& wanted)
{
    const Result<size_t> scene = chooseScene(model, wanted);
    if (!scene)
        return scene.error();
    Result<SceneNodes> nodes = Walk(model).run(model.scenes[*scene].nodes);
    if (nodes && wanted.empty() && model.defaultScene == -1 && model.scenes.size() > 1)
        nodes->warnings.push_back(fmt::format(
            "the file names no default scene; the first of {} is compiled (--scene chooses)", model.scenes.size()));
    return nodes;
}
