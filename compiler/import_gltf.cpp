#include "compiler/import_gltf.h"

#include "compiler/gltf_material.h"
#include "compiler/gltf_mesh.h"
#include "compiler/gltf_variants.h"
#include "compiler/parallel.h"
#include "compiler/tangents.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
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
    Warnings warnings;
    uint64_t generated_normals = 0;
    uint64_t generated_tangents = 0;
    uint64_t weightless_vertices = 0;
    bool lacks_joints = false; // though its node has a skin
};

/// The shapes that `instances` show, by mesh, and which of them each instance shows.
std::vector<Shape> shapesInUse(const std::vector<MeshInstance>& instances, std::vector<size_t>& shape_of_instance)
{
    using Key = std::tuple<int, std::vector<double>, size_t>; // mesh, weights, 1 + index of a skinned instance
    std::map<Key, std::vector<size_t>> instances_of;
    for (size_t i = 0; i < instances.size(); ++i)
        instances_of[{instances[i].mesh, instances[i].morph_weights, instances[i].skin == -1 ? 0 : i + 1}].push_back(i);
    std::vector<Shape> shapes;
    shape_of_instance.resize(instances.size());
    for (const auto& [key, members] : instances_of)
    {
        const auto& [mesh, weights, skinned] = key;
        for (const size_t i : members)
            shape_of_instance[i] = shapes.size();
        shapes.push_back({mesh, weights, skinned == 0 ? nullptr : &instances[skinned - 1]});
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
        total += std::min<uint64_t>(model.accessors[size_t(positions->second)].count, kMostVertices + 1);
        if (total > kMostVertices)
            return Error{ExitCode::kUnsupported,
                         fmt::format("its meshes, in all their poses, have more than {} vertices", kMostVertices)};
    }
    return Success{};
}

/// Reads the materials that `jobs` name and sets the jobs' material indices.
void readMaterials(const GltfFile& file, int variant, std::vector<Job>& jobs, ImportedScene& imported)
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

/// @param pose of the shape's skin, null without one
void readGeometry(const tinygltf::Model& model, const SkinPose* pose, Job& job)
{
    const Shape& shape = *job.shape;
    const std::string pointer = fmt::format("/meshes/{}/primitives/{}", shape.mesh, job.number);
    const auto leaveOut = [&](const Error& error)
    { job.warnings.push_back(warningOf(WarningKind::kBadGeometry, error, pointer, "the primitive is left out")); };
    auto read = readPrimitive(model, *job.source,
                              {.morph_weights = shape.morph_weights, .joint_count = pose ? pose->joints.size() : 0},
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
        if (const Status status = skinMesh(*pose, primitive.influences, shape.skinned->to_world, primitive.mesh);
            !status)
            return leaveOut(status.error());
    }
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

void noteGaps(const std::vector<Job>& jobs, SceneData& scene)
{
    uint64_t weightless_vertices = 0;
    uint64_t without_joints = 0;
    for (const Job& job : jobs)
    {
        if (!job.result && job.warnings.empty() &&
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
} // namespace

Result<ImportedScene> importScene(const GltfFile& file, const ImportChoice& choice)
{
    const tinygltf::Model& model = file.model;
    const Result<int> variant = findVariant(model, choice.variant);
    if (!variant)
        return variant.error();
    Result<SceneNodes> nodes = walkScene(model, choice.scene);
    if (!nodes)
        return nodes.error();
    ImportedScene imported;
    SceneData& scene = imported.scene;
    scene.generator = model.asset.generator;
    scene.copyright = model.asset.copyright;
    scene.warnings = file.warnings;
    scene.warnings.insert(scene.warnings.end(), nodes->warnings.begin(), nodes->warnings.end());
    scene.lights = std::move(nodes->lights);
    scene.cameras = std::move(nodes->cameras);

    std::vector<size_t> shape_of_instance;
    std::vector<Shape> shapes = shapesInUse(nodes->meshes, shape_of_instance);
    std::vector<Job> jobs = primitivesOf(model, shapes);
    const std::map<int, SkinPose> poses = poseSkins(file, shapes, scene.warnings);
    if (const Status status = checkVertexTotal(model, jobs); !status)
        return status.error();
    readAll(file, poses, jobs, scene.warnings);
    readMaterials(file, *variant, jobs, imported);
    parallelFor(jobs.size(), [&](size_t i) { completeGeometry(scene, jobs[i]); });
    noteGaps(jobs, scene);

    takePrimitives(jobs, shapes, imported);
    for (size_t i = 0; i < nodes->meshes.size(); ++i)
    {
        const Shape& shape = shapes[shape_of_instance[i]];
        Transform to_world = nodes->meshes[i].to_world;
        if (const SkinPose* const pose = poseOf(poses, shape))
            to_world = Transform{.translation = {pose->origin.x, pose->origin.y, pose->origin.z}};
        imported.instances.push_back({shape.first_primitive, shape.primitive_count, to_world});
    }
    return imported;
}
