#include "compiler/import_gltf.h"

#include "compiler/gltf_material.h"
#include "compiler/gltf_mesh.h"
#include "compiler/gltf_morph.h"
#include "compiler/gltf_variants.h"
#include "compiler/parallel.h"
#include "compiler/tangents.h"
#include "format/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

namespace
{
constexpr float kCreaseAngle = 1.0471976f; // 60 degrees: sharper edges stay sharp where normals are made

/// A mesh as one or more instances show it: morphed by their weights, placed by their joints.
struct Shape
{
    int mesh = 0;
    std::vector<double> morph_weights;
    const MeshInstance* skinned = nullptr; // the one instance that shows it, if joints place it
    bool moves = false;                    // its vertices are kept in their own space, too
    bool morphs = false;                   // with their morph targets
    size_t first_primitive = 0;            // into ImportedScene::primitives, once they are there
    size_t primitive_count = 0;
};

/// One primitive of a shape, on its way in.
struct Job
{
    const Shape* shape;
    const tinygltf::Primitive* source;
    size_t number; // of the primitive in its mesh
    std::optional<MeshPrimitive> result;
    GltfPrimitive base; // of a shape that moves: before morphing and skinning, but for triangles
    std::vector<MorphTarget> targets;
    Warnings warnings;
    Warnings late_warnings; // of completeMotion()
    uint64_t generated_normals = 0;
    uint64_t generated_tangents = 0;
    uint64_t weightless_vertices = 0;
    bool lacks_joints = false; // though its node has a skin
};

/// Whether animations move an instance's node or set its morph weights.
bool movesByNode(const tinygltf::Model& model, const MovingNodes& moving, const MeshInstance& instance)
{
    return moving.places[instance.node] ||
           (moving.morphs[instance.node] && morphWeightCount(model, model.nodes[instance.node]) > 0);
}

bool movesByJoints(const GltfFile& file, const MovingNodes& moving, const MeshInstance& instance)
{
    if (instance.skin < 0 || size_t(instance.skin) >= file.skins.size())
        return false;
    const std::vector<int>& joints = file.skins[size_t(instance.skin)].joints;
    return std::any_of(joints.begin(), joints.end(),
                       [&](int joint)
                       { return joint >= 0 && size_t(joint) < moving.places.size() && moving.places[size_t(joint)]; });
}

/// The shapes that `instances` show, by mesh, and which of them each instance shows.
std::vector<Shape> shapesInUse(const GltfFile& file, const MovingNodes& moving,
                               const std::vector<MeshInstance>& instances, std::vector<size_t>& shape_of_instance)
{
    // mesh, weights, 1 + index of a skinned instance, moves, morphs
    using Key = std::tuple<int, std::vector<double>, size_t, bool, bool>;
    std::map<Key, std::vector<size_t>> instances_of;
    for (size_t i = 0; i < instances.size(); ++i)
        instances_of[{instances[i].mesh, instances[i].morph_weights, instances[i].skin == -1 ? 0 : i + 1,
                      movesByNode(file.model, moving, instances[i]) || movesByJoints(file, moving, instances[i]),
                      moving.morphs[instances[i].node]}]
            .push_back(i);
    std::vector<Shape> shapes;
    shape_of_instance.resize(instances.size());
    for (const auto& [key, members] : instances_of)
    {
        const auto& [mesh, weights, skinned, shape_moves, morphs] = key;
        for (const size_t i : members)
            shape_of_instance[i] = shapes.size();
        shapes.push_back({mesh, weights, skinned == 0 ? nullptr : &instances[skinned - 1], shape_moves, morphs});
    }
    return shapes;
}

std::vector<Job> primitivesOf(const tinygltf::Model& model, const std::vector<Shape>& shapes)
{
    std::vector<Job> jobs;
    for (const Shape& shape : shapes)
    {
        const auto& primitives = model.meshes[size_t(shape.mesh)].primitives;
        for (size_t p = 0; p < primitives.size(); ++p)
            jobs.push_back({.shape = &shape, .source = &primitives[p], .number = p, .result = {}, .warnings = {}});
    }
    return jobs;
}

/// Each shape has vertices of its own, so that many instances could ask for much memory.
Status checkVertexTotal(const tinygltf::Model& model, const std::vector<Job>& jobs)
{
    constexpr uint64_t kMostVertices = 150'000'000;
    uint64_t total = 0;
    for (const Job& job : jobs)
    {
        const auto positions = job.source->attributes.find("POSITION");
        if (positions == job.source->attributes.end() || positions->second < 0 ||
            size_t(positions->second) >= model.accessors.size())
            continue;
        const tinygltf::Accessor& accessor = model.accessors[size_t(positions->second)];
        // Where it claims more than its bytes can hold it is damaged, and only its primitive is left out.
        const bool has_view = accessor.bufferView >= 0 && size_t(accessor.bufferView) < model.bufferViews.size();
        const uint64_t most = has_view ? model.bufferViews[size_t(accessor.bufferView)].byteLength : kMostVertices + 1;
        total += std::min<uint64_t>(accessor.count, most);
        if (total > kMostVertices)
            return Error{ExitCode::kUnsupported,
                         fmt::format("its meshes, in all their poses, have more than {} vertices", kMostVertices)};
    }
    return Success{};
}

/// Reads the materials that `jobs` name and sets the jobs' material indices.
/// @return [material of the file] its number in the scene, -1: it is not used
std::vector<int> readMaterials(const GltfFile& file, int variant, std::vector<Job>& jobs, ImportedScene& imported)
{
    std::set<int> in_use;
    const auto material = [&](const Job& job) { return std::max(materialOf(*job.source, variant), -1); };
    for (const Job& job : jobs)
        if (job.result)
            in_use.insert(material(job));
    const std::vector<int> used(in_use.begin(), in_use.end());
    importMaterials(file, used, imported.scene, imported.images);
    for (Job& job : jobs)
        if (job.result)
            job.result->material = uint32_t(std::lower_bound(used.begin(), used.end(), material(job)) - used.begin());
    std::vector<int> numbers(file.model.materials.size(), -1);
    for (size_t i = 0; i < used.size(); ++i)
        if (used[i] >= 0)
            numbers[size_t(used[i])] = int(i);
    return numbers;
}

/// The poses of the skins that `shapes` need, by number; without those that are damaged.
std::map<int, SkinPose> poseSkins(const GltfFile& file, const std::vector<Shape>& shapes, Warnings& warnings)
{
    std::map<int, SkinPose> poses;
    std::set<int> damaged;
    NodeTransforms nodes(file.model);
    for (const Shape& shape : shapes)
    {
        if (shape.skinned == nullptr || poses.contains(shape.skinned->skin) || damaged.contains(shape.skinned->skin))
            continue;
        Result<SkinPose> pose = poseSkin(file, shape.skinned->skin, nodes);
        if (pose)
        {
            poses.emplace(shape.skinned->skin, std::move(*pose));
            continue;
        }
        damaged.insert(shape.skinned->skin);
        warnings.push_back(warningOf(WarningKind::kBadGeometry, pose.error(),
                                     fmt::format("/skins/{}", shape.skinned->skin),
                                     "its meshes are drawn where their nodes are"));
    }
    return poses;
}

const SkinPose* poseOf(const std::map<int, SkinPose>& poses, const Shape& shape)
{
    const auto pose = shape.skinned == nullptr ? poses.end() : poses.find(shape.skinned->skin);
    return pose == poses.end() ? nullptr : &pose->second;
}

/// Takes a primitive that moves, and morphs it to the weights at rest.
void keepBase(const tinygltf::Model& model, GltfPrimitive primitive, const std::string& pointer, Job& job)
{
    MeshPrimitive mesh = primitive.mesh;
    if (const Shape& shape = *job.shape; shape.morphs)
    {
        auto targets = readMorphTargets(model, *job.source, job.source->targets.size(), mesh);
        const Status morphed =
            targets ? applyMorphTargets(model, *job.source, shape.morph_weights, mesh) : Status(targets.error());
        if (morphed)
            job.targets = std::move(*targets);
        else
        {
            mesh = primitive.mesh;
            job.warnings.push_back(
                warningOf(WarningKind::kBadGeometry, morphed.error(), pointer, "it is drawn without morphing"));
        }
    }
    mesh.sources.resize(mesh.positions.size());
    std::iota(mesh.sources.begin(), mesh.sources.end(), 0u);
    primitive.mesh.triangles = {};
    job.base = std::move(primitive);
    job.result = std::move(mesh);
}

/// @param pose of the shape's skin, null without one
void readGeometry(const tinygltf::Model& model, const SkinPose* pose, Job& job)
{
    const Shape& shape = *job.shape;
    const std::string pointer = fmt::format("/meshes/{}/primitives/{}", shape.mesh, job.number);
    const auto leaveOut = [&](const Error& error)
    { job.warnings.push_back(warningOf(WarningKind::kBadGeometry, error, pointer, "the primitive is left out")); };
    auto read = readPrimitive(model, *job.source,
                              {.morph_weights = shape.morphs ? std::span<const double>() : shape.morph_weights,
                               .joint_count = pose ? pose->joints.size() : 0},
                              pointer, job.warnings);
    if (!read)
        return leaveOut(read.error());
    if (!*read)
        return;
    GltfPrimitive& primitive = **read;
    if (pose != nullptr)
    {
        job.weightless_vertices = primitive.influences.weightless_vertices;
        job.lacks_joints = !job.source->attributes.contains("JOINTS_0");
    }
    if (shape.moves)
        return keepBase(model, std::move(primitive), pointer, job);
    if (pose != nullptr)
        if (const auto mirrored = skinMesh(*pose, primitive.influences, shape.skinned->to_world, primitive.mesh);
            !mirrored)
            return leaveOut(mirrored.error());
    job.result = std::move(primitive.mesh);
}

/// Reads all jobs. Shapes of one mesh share their damage, which is reported once.
void readAll(const GltfFile& file, const std::map<int, SkinPose>& poses, std::vector<Job>& jobs, Warnings& warnings)
{
    parallelFor(jobs.size(), [&](size_t i) { readGeometry(file.model, poseOf(poses, *jobs[i].shape), jobs[i]); });
    std::set<std::pair<std::string, std::string>> reported;
    for (const Job& job : jobs)
        for (const Warning& warning : job.warnings)
            if (reported.emplace(warning.pointer, warning.message).second)
                warnings.push_back(warning);
}

/// Makes the normals and tangents that the file leaves out.
void completeGeometry(const SceneData& scene, Job& job)
{
    if (!job.result)
        return;
    if (job.result->normals.empty())
        job.generated_normals = generateNormals(*job.result, kCreaseAngle);
    const gpu::Material& material = scene.materials[job.result->material];
    const uint32_t map = tangentTexture(material);
    if ((map != gpu::kNone || material.anisotropy > 0) && job.result->tangents.empty())
        job.generated_tangents =
            generateTangents(*job.result, map == gpu::kNone ? TextureUse{} : scene.texture_uses[map]);
}

Influences expanded(const Influences& influences, const std::vector<uint32_t>& sources)
{
    Influences result{.per_vertex = influences.per_vertex};
    for (const uint32_t v : sources)
        for (size_t k = 0; k < influences.per_vertex; ++k)
        {
            result.joints.push_back(influences.joints[v * influences.per_vertex + k]);
            result.weights.push_back(influences.weights[v * influences.per_vertex + k]);
        }
    return result;
}

/// Sets apart what moves a complete primitive, and places it as at rest.
void completeMotion(const SkinPose* pose, Job& job)
{
    if (!job.result || !job.shape->moves)
        return;
    MeshPrimitive& mesh = *job.result;
    MovingVertices moving;
    const MeshPrimitive& base = job.base.mesh;
    for (size_t v = 0; v < mesh.positions.size(); ++v)
    {
        const uint32_t source = mesh.sources[v];
        moving.positions.push_back(base.positions[source]);
        moving.normals.push_back(base.normals.empty() ? mesh.normals[v] : base.normals[source]);
        if (!mesh.tangents.empty())
            moving.tangents.push_back(base.tangents.empty() ? mesh.tangents[v] : base.tangents[source]);
    }
    if (pose != nullptr)
    {
        auto mirrored =
            skinMesh(*pose, expanded(job.base.influences, mesh.sources), job.shape->skinned->to_world, mesh);
        if (!mirrored)
        {
            job.late_warnings.push_back(warningOf(WarningKind::kBadGeometry, mirrored.error(),
                                                  fmt::format("/meshes/{}/primitives/{}", job.shape->mesh, job.number),
                                                  "the primitive is left out"));
            job.result.reset();
            return;
        }
        moving.mirrored = std::move(*mirrored);
    }
    moving.sources = std::move(mesh.sources);
    moving.influences = std::move(job.base.influences);
    moving.targets = std::move(job.targets);
    mesh.moving = std::move(moving);
}

void noteGaps(const std::vector<Job>& jobs, SceneData& scene)
{
    uint64_t weightless_vertices = 0;
    uint64_t without_joints = 0;
    for (const Job& job : jobs)
    {
        scene.warnings.insert(scene.warnings.end(), job.late_warnings.begin(), job.late_warnings.end());
        if (!job.result && job.warnings.empty() && job.late_warnings.empty() &&
            !job.source->attributes.empty()) // else it was damaged, and that is said
            ++scene.counts.dropped_primitives;
        scene.counts.generated_normals += job.generated_normals;
        scene.counts.generated_tangents += job.generated_tangents;
        weightless_vertices += job.weightless_vertices;
        without_joints += job.lacks_joints;
    }
    if (scene.counts.dropped_primitives > 0)
        scene.warnings.push_back(
            {WarningKind::kLeftOut, "",
             fmt::format("{} primitives without a surface (points, lines, no positions) are left out",
                         scene.counts.dropped_primitives),
             ""});
    if (weightless_vertices > 0)
        scene.warnings.push_back(
            fmt::format("{} vertices of skinned meshes have no weights; they follow the first joint that they name",
                        weightless_vertices));
    if (without_joints > 0)
        scene.warnings.push_back(fmt::format("{} primitives of skinned meshes have no joints (JOINTS_0); they stand "
                                             "where their node does",
                                             without_joints));
}

/// Moves the primitives out of `jobs`, each shape's in a row.
void takePrimitives(std::vector<Job>& jobs, std::vector<Shape>& shapes, ImportedScene& imported)
{
    for (Shape& shape : shapes)
        shape.first_primitive = shape.primitive_count = 0;
    for (Job& job : jobs)
    {
        if (!job.result)
            continue;
        Shape& shape = shapes[size_t(job.shape - shapes.data())];
        if (shape.primitive_count++ == 0)
            shape.first_primitive = imported.primitives.size();
        imported.primitives.push_back(std::move(*job.result));
    }
}
/// Those that move, or change otherwise.
void addLightsAndCameras(const tinygltf::Model& model, const std::vector<Animation>& animations,
                         const MovingNodes& moving, const SceneNodes& nodes, SceneData& scene, MotionBuilder& motion)
{
    using package::ChannelObject;
    std::set<std::pair<ChannelObject, size_t>> changing;
    for (const Animation& animation : animations)
        for (const AnimationTrack& track : animation.tracks)
            changing.emplace(package::kindOf(track.target)->object, track.item);
    for (size_t i = 0; i < nodes.light_nodes.size(); ++i)
    {
        const size_t node = nodes.light_nodes[i];
        const int light = lightOf(model.nodes[node]);
        if (!moving.places[node] && !changing.contains({ChannelObject::kLight, size_t(light)}))
            continue;
        scene.lights[i].moves = true;
        motion.addLight(uint32_t(i), node, model.lights[size_t(light)]);
    }
    for (size_t i = 0; i < nodes.camera_nodes.size(); ++i)
    {
        const size_t node = nodes.camera_nodes[i];
        if (moving.places[node] || changing.contains({ChannelObject::kCamera, size_t(model.nodes[node].camera)}))
            motion.addCamera(uint32_t(i), node);
    }
}
} // namespace

Result<ImportedScene> importScene(const GltfFile& file, const ImportChoice& choice)
{
    const tinygltf::Model& model = file.model;
    const Result<int> variant = findVariant(model, choice.variant);
    if (!variant)
        return variant.error();
    ImportedScene imported;
    SceneData& scene = imported.scene;
    scene.warnings = file.warnings;
    const std::vector<Animation> animations = readAnimations(file, scene.warnings);
    const MovingNodes moving(model, animations);
    Result<SceneNodes> nodes = walkScene(model, choice.scene, moving.appears);
    if (!nodes)
        return nodes.error();
    scene.generator = model.asset.generator;
    scene.copyright = model.asset.copyright;
    scene.warnings.insert(scene.warnings.end(), nodes->warnings.begin(), nodes->warnings.end());
    scene.lights = std::move(nodes->lights);
    scene.cameras = std::move(nodes->cameras);

    std::vector<size_t> shape_of_instance;
    std::vector<Shape> shapes = shapesInUse(file, moving, nodes->meshes, shape_of_instance);
    std::vector<Job> jobs = primitivesOf(model, shapes);
    const std::map<int, SkinPose> poses = poseSkins(file, shapes, scene.warnings);
    for (Shape& shape : shapes)
        if (shape.skinned != nullptr && poseOf(poses, shape) == nullptr) // damaged: its joints move nothing
            shape.moves = movesByNode(model, moving, *shape.skinned);
    if (const Status status = checkVertexTotal(model, jobs); !status)
        return status.error();
    readAll(file, poses, jobs, scene.warnings);
    const std::vector<int> material_of = readMaterials(file, *variant, jobs, imported);
    parallelFor(jobs.size(),
                [&](size_t i)
                {
                    completeGeometry(scene, jobs[i]);
                    completeMotion(poseOf(poses, *jobs[i].shape), jobs[i]);
                });
    noteGaps(jobs, scene);

    takePrimitives(jobs, shapes, imported);
    MotionBuilder motion(model, animations);
    for (size_t i = 0; i < nodes->meshes.size(); ++i)
    {
        const Shape& shape = shapes[shape_of_instance[i]];
        ImportedInstance instance{shape.first_primitive, shape.primitive_count, nodes->meshes[i].to_world};
        const SkinPose* const pose = poseOf(poses, shape);
        if (pose != nullptr)
            instance.to_world = Transform{.translation = {pose->origin.x, pose->origin.y, pose->origin.z}};
        if (shape.moves)
            instance.moving = motion.addObject(nodes->meshes[i], pose);
        imported.instances.push_back(instance);
    }
    std::stable_partition(imported.instances.begin(), imported.instances.end(),
                          [](const ImportedInstance& instance) { return !instance.moving; });
    addLightsAndCameras(model, animations, moving, *nodes, scene, motion);
    scene.motion = motion.finish(material_of);
    return imported;
}
