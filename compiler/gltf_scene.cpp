#include "compiler/gltf_scene.h"

#include "compiler/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>

namespace
{
Error invalid(std::string_view text, size_t node)
{
    return {ExitCode::kInvalid, fmt::format("{} (/nodes/{})", text, node)};
}

/// Column-major rotation matrix of a quaternion, normalised.
std::array<double, 9> rotationMatrix(double x, double y, double z, double w)
{
    const double l = std::sqrt(x * x + y * y + z * z + w * w);
    if (!(l > 0))
        return {1, 0, 0, 0, 1, 0, 0, 0, 1};
    x /= l, y /= l, z /= l, w /= l;
    return {1 - 2 * (y * y + z * z), 2 * (x * y + z * w),     2 * (x * z - y * w),
            2 * (x * y - z * w),     1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
            2 * (x * z + y * w),     2 * (y * z - x * w),     1 - 2 * (x * x + y * y)};
}

Transform fromTrs(const std::array<double, 3>& t, const std::array<double, 4>& r, const std::array<double, 3>& s)
{
    Transform result{rotationMatrix(r[0], r[1], r[2], r[3]), t};
    for (size_t i = 0; i < 9; ++i)
        result.linear[i] *= s[i / 3];
    return result;
}

bool isFiniteTransform(const Transform& t)
{
    const auto finite = [](double v) { return std::isfinite(v); };
    return std::all_of(t.linear.begin(), t.linear.end(), finite) &&
           std::all_of(t.translation.begin(), t.translation.end(), finite);
}

Result<Transform> localTransform(const tinygltf::Node& node, size_t index)
{
    Transform result;
    if (!node.matrix.empty())
    {
        const auto& m = node.matrix;
        if (m.size() != 16 || m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
            return invalid("a node's matrix is not an affine 4 x 4 matrix", index);
        result = {{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
    }
    else
    {
        const auto& t = node.translation;
        const auto& r = node.rotation;
        const auto& s = node.scale;
        if ((!t.empty() && t.size() != 3) || (!r.empty() && r.size() != 4) || (!s.empty() && s.size() != 3))
            return invalid("a node's translation, rotation or scale has a wrong number of values", index);
        result = fromTrs(t.empty() ? std::array<double, 3>{0, 0, 0} : std::array<double, 3>{t[0], t[1], t[2]},
                         r.empty() ? std::array<double, 4>{0, 0, 0, 1} : std::array<double, 4>{r[0], r[1], r[2], r[3]},
                         s.empty() ? std::array<double, 3>{1, 1, 1} : std::array<double, 3>{s[0], s[1], s[2]});
    }
    if (!isFiniteTransform(result))
        return invalid("a node's transform is not finite", index);
    return result;
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
        transforms[i] = fromTrs({at(*t, 0, 0), at(*t, 1, 0), at(*t, 2, 0)},
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
    const bool good = from.type == "orthographic"
                          ? view.orthographic_height > 0 && std::isfinite(view.orthographic_height)
                          : view.vertical_fov > 0 && view.vertical_fov < 3.1415f;
    if (!good)
        return Error{ExitCode::kInvalid, fmt::format("a camera has no usable field of view (/cameras/{})", index)};
    return view;
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
        for (const Transform& instance : *instances)
            nodes_.meshes.push_back({node.mesh, to_world * instance});
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
} // namespace

Result<SceneNodes> walkScene(const tinygltf::Model& model)
{
    if (model.scenes.empty())
        return Error{ExitCode::kInvalid, "it has no scene, so there is nothing to compile (/scenes)"};
    const int scene = model.defaultScene == -1 ? 0 : model.defaultScene;
    if (scene < 0 || size_t(scene) >= model.scenes.size())
        return Error{ExitCode::kInvalid, fmt::format("scene {} does not exist (/scene)", scene)};
    Result<SceneNodes> nodes = Walk(model).run(model.scenes[size_t(scene)].nodes);
    if (nodes && model.defaultScene == -1 && model.scenes.size() > 1)
        nodes->warnings.push_back(
            fmt::format("the file names no default scene; the first of {} is compiled", model.scenes.size()));
    return nodes;
}
