#include "compiler/gltf_skin.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace
{
/// Writes one set of four joints a vertex, from the `first` of its influences on.
Status appendSet(const FloatArray& joints, const FloatArray& weights, uint32_t first, size_t joint_count,
                 Influences& influences)
{
    for (size_t v = 0; v < joints.count; ++v)
        for (uint32_t c = 0; c < 4; ++c)
        {
            const float weight = weights.values[4 * v + c];
            const float joint = joints.values[4 * v + c];
            const size_t to = v * influences.per_vertex + first + c;
            influences.weights[to] = weight > 0 && std::isfinite(weight) ? weight : 0;
            const bool exists = joint >= 0 && joint < float(joint_count);
            if (!exists && influences.weights[to] > 0)
                return Error{ExitCode::kInvalid,
                             fmt::format("vertex {} follows joint {} of a skin that has {}", v, joint, joint_count)};
            influences.joints[to] = exists ? uint32_t(joint) : 0;
        }
    return Success{};
}

void normalizeWeights(Influences& influences)
{
    for (size_t first = 0; first < influences.weights.size(); first += influences.per_vertex)
    {
        float* const weights = &influences.weights[first];
        double sum = 0;
        for (uint32_t k = 0; k < influences.per_vertex; ++k)
            sum += weights[k];
        if (sum > 0)
            for (uint32_t k = 0; k < influences.per_vertex; ++k)
                weights[k] = float(weights[k] / sum);
        else
        {
            weights[0] = 1;
            ++influences.weightless_vertices;
        }
    }
}

/// The weighted sum of a vertex's joint matrices.
Transform blend(const SkinPose& pose, const Influences& influences, size_t vertex)
{
    Transform sum{{}, {}};
    for (size_t k = vertex * influences.per_vertex; k < (vertex + 1) * influences.per_vertex; ++k)
    {
        const double weight = influences.weights[k];
        const Transform& joint = pose.joints[influences.joints[k]];
        for (size_t i = 0; weight > 0 && i < sum.linear.size(); ++i)
            sum.linear[i] += weight * joint.linear[i];
        for (size_t i = 0; weight > 0 && i < sum.translation.size(); ++i)
            sum.translation[i] += weight * joint.translation[i];
    }
    return sum;
}
} // namespace

Result<Influences> readInfluences(const AttributeSource& source, size_t vertex_count, size_t joint_count)
{
    Influences influences;
    while (source.has(fmt::format("JOINTS_{}", influences.per_vertex / 4)))
        influences.per_vertex += 4;
    influences.joints.resize(influences.per_vertex * vertex_count);
    influences.weights.resize(influences.per_vertex * vertex_count);
    for (uint32_t set = 0; set < influences.per_vertex / 4; ++set)
    {
        const std::string weights_name = fmt::format("WEIGHTS_{}", set);
        if (!source.has(weights_name))
            return Error{ExitCode::kInvalid, fmt::format("JOINTS_{} comes without {}", set, weights_name)};
        const Result<FloatArray> joints = source.read(fmt::format("JOINTS_{}", set), 4, 4, vertex_count);
        const Result<FloatArray> weights = source.read(weights_name, 4, 4, vertex_count);
        if (!joints || !weights)
            return joints ? weights.error() : joints.error();
        if (const Status status = appendSet(*joints, *weights, 4 * set, joint_count, influences); !status)
            return status.error();
    }
    normalizeWeights(influences);
    return influences;
}

Result<SkinPose> poseSkin(const GltfFile& file, int skin, NodeTransforms& nodes)
{
    const auto invalid = [skin](std::string_view text) {
        return Error{ExitCode::kInvalid, fmt::format("{} (/skins/{})", text, skin)};
    };
    if (skin < 0 || size_t(skin) >= file.skins.size())
        return invalid("a node names a skin that does not exist");
    const GltfSkin& from = file.skins[size_t(skin)];
    if (from.joints.empty())
        return invalid("a skin has no joints");
    FloatArray matrices;
    if (from.inverse_bind_matrices)
    {
        Result<FloatArray> read = readFloats(file.model, *from.inverse_bind_matrices, 16, 16);
        if (!read)
            return invalid(read.error().message);
        if (read->count < from.joints.size())
            return invalid(
                fmt::format("a skin has {} joints but {} inverse bind matrices", from.joints.size(), read->count));
        matrices = std::move(*read);
    }
    SkinPose pose;
    for (size_t j = 0; j < from.joints.size(); ++j)
    {
        Result<Transform> joint = nodes.toWorld(from.joints[j]);
        if (!joint)
            return invalid(joint.error().message);
        if (j == 0)
            pose.origin = joint->point({});
        pose.nodes.push_back(size_t(from.joints[j]));
        pose.binds.emplace_back();
        if (matrices.count > 0)
        {
            std::array<double, 16> m;
            std::copy_n(matrices.values.begin() + ptrdiff_t(16 * j), 16, m.begin());
            const std::optional<Transform> inverse_bind = affineTransform(m);
            if (!inverse_bind)
                return invalid(fmt::format("inverse bind matrix {} is not an affine 4 x 4 matrix", j));
            pose.binds.back() = *inverse_bind;
            joint = *joint * *inverse_bind;
        }
        if (!isFiniteTransform(*joint))
            return invalid(fmt::format("joint {} has a transform that is not finite", j));
        pose.joints.push_back(*joint);
    }
    return pose;
}

Result<std::vector<bool>> skinMesh(const SkinPose& pose, const Influences& influences, const Transform& node_to_world,
                                   MeshPrimitive& mesh)
{
    std::vector<bool> mirrored(mesh.positions.size());
    for (size_t v = 0; v < mesh.positions.size(); ++v)
    {
        const Transform to_world = influences.per_vertex > 0 ? blend(pose, influences, v) : node_to_world;
        mirrored[v] = to_world.determinant() < 0;
        mesh.positions[v] = toFloat(to_world.point(toDouble(mesh.positions[v])) - pose.origin);
        if (!isFinite(mesh.positions[v]))
            return Error{ExitCode::kInvalid, "its joints move vertices beyond the range of numbers"};
        if (!mesh.normals.empty())
            mesh.normals[v] = toFloat(unitOrZero(to_world.normal(unitOrZero(toDouble(mesh.normals[v])))));
        if (mesh.tangents.empty())
            continue;
        const gpu::vec4 t = mesh.tangents[v];
        const gpu::vec3 along = toFloat(unitOrZero(to_world.vector({t.x, t.y, t.z})));
        mesh.tangents[v] = {along.x, along.y, along.z, mirrored[v] ? -t.w : t.w};
    }
    for (gpu::uvec3& t : mesh.triangles)
        if (int(mirrored[t.x]) + int(mirrored[t.y]) + int(mirrored[t.z]) >= 2)
            std::swap(t.y, t.z);
    return mirrored;
}
