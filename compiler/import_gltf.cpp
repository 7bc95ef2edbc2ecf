#include "compiler/import_gltf.h"

#include "compiler/gltf_material.h"
#include "compiler/gltf_mesh.h"
#include "compiler/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace
{
constexpr float kCreaseAngle = 1.0471976f; // 60 degrees: sharper edges stay sharp where normals are made

/// One primitive of a mesh in use, on its way in.
struct Job
{
    int mesh;
    size_t primitive;
    std::optional<MeshPrimitive> result;
    Warnings warnings;
    uint64_t generated_normals = 0;
    uint64_t generated_tangents = 0;
};

/// The primitives of every mesh that some instance shows, by mesh and number.
std::vector<Job> primitivesInUse(const tinygltf::Model& model, const std::vector<MeshInstance>& instances)
{
    std::set<int> meshes;
    for (const MeshInstance& instance : instances)
        meshes.insert(instance.mesh);
    std::vector<Job> jobs;
    for (const int mesh : meshes)
        for (size_t p = 0; p < model.meshes[size_t(mesh)].primitives.size(); ++p)
            jobs.push_back({.mesh = mesh, .primitive = p, .result = {}, .warnings = {}});
    return jobs;
}

/// Reads the materials that `jobs` name and sets the jobs' material indices.
void readMaterials(const GltfFile& file, std::vector<Job>& jobs, ImportedScene& imported)
{
    std::set<int> in_use;
    const auto material = [&](const Job& job)
    { return file.model.meshes[size_t(job.mesh)].primitives[job.primitive].material; };
    for (const Job& job : jobs)
        if (job.result)
            in_use.insert(std::max(material(job), -1));
    const std::vector<int> used(in_use.begin(), in_use.end());
    importMaterials(file, used, imported.scene, imported.images);
    for (Job& job : jobs)
        if (job.result)
            job.result->material =
                uint32_t(std::lower_bound(used.begin(), used.end(), std::max(material(job), -1)) - used.begin());
}

void readGeometry(const tinygltf::Model& model, Job& job)
{
    const std::string pointer = fmt::format("/meshes/{}/primitives/{}", job.mesh, job.primitive);
    Result<std::optional<MeshPrimitive>> read =
        readPrimitive(model, model.meshes[size_t(job.mesh)].primitives[job.primitive], pointer, job.warnings);
    if (!read)
        job.warnings.push_back({WarningKind::kBadGeometry, pointer, read.error().message, "the primitive is left out",
                                read.error().code});
    else
        job.result = std::move(*read);
}

/// Makes the normals and tangents that the file leaves out.
void completeGeometry(const SceneData& scene, Job& job)
{
    if (!job.result)
        return;
    if (job.result->normals.empty())
        job.generated_normals = generateNormals(*job.result, kCreaseAngle);
    const uint32_t normal_map = scene.materials[job.result->material].normal_texture;
    if (normal_map != gpu::kNone && job.result->tangents.empty())
        job.generated_tangents = generateTangents(*job.result, scene.texture_uses[normal_map]);
}

void noteGaps(const GltfFile& file, const std::vector<Job>& jobs, SceneData& scene)
{
    bool morphs = false;
    for (const Job& job : jobs)
    {
        const tinygltf::Primitive& primitive = file.model.meshes[size_t(job.mesh)].primitives[job.primitive];
        morphs |= !primitive.targets.empty();
        if (!job.result && job.warnings.empty() && !primitive.attributes.empty()) // else it was damaged, and that is said
            ++scene.counts.dropped_primitives;
        scene.counts.generated_normals += job.generated_normals;
        scene.counts.generated_tangents += job.generated_tangents;
    }
    if (scene.counts.dropped_primitives > 0)
        scene.warnings.push_back(
            {WarningKind::kLeftOut, "",
             fmt::format("{} primitives without a surface (points, lines, no positions) are left out",
                         scene.counts.dropped_primitives),
             ""});
    if (morphs)
        scene.warnings.push_back(
            {WarningKind::kLeftOut, "", "morph targets are left out: meshes are compiled in their base shape", ""});
}
} // namespace

Result<ImportedScene> importScene(const GltfFile& file)
{
    const tinygltf::Model& model = file.model;
    Result<SceneNodes> nodes = walkScene(model);
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

    std::vector<Job> jobs = primitivesInUse(model, nodes->meshes);
    parallelFor(jobs.size(), [&](size_t i) { readGeometry(model, jobs[i]); });
    for (const Job& job : jobs)
        scene.warnings.insert(scene.warnings.end(), job.warnings.begin(), job.warnings.end());
    readMaterials(file, jobs, imported);
    parallelFor(jobs.size(), [&](size_t i) { completeGeometry(scene, jobs[i]); });
    noteGaps(file, jobs, scene);

    std::map<int, ImportedInstance> by_mesh;
    for (Job& job : jobs)
    {
        ImportedInstance& range =
            by_mesh.try_emplace(job.mesh, ImportedInstance{imported.primitives.size(), 0, {}}).first->second;
        if (!job.result)
            continue;
        ++range.primitive_count;
        imported.primitives.push_back(std::move(*job.result));
    }
    for (const MeshInstance& instance : nodes->meshes)
        if (const auto range = by_mesh.find(instance.mesh); range != by_mesh.end())
            imported.instances.push_back(
                {range->second.first_primitive, range->second.primitive_count, instance.to_world});
    return imported;
}
