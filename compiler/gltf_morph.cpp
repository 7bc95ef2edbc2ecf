#include "compiler/gltf_morph.h"

#include "compiler/gltf_accessor.h"
#include "compiler/linear.h"

#include <fmt/format.h>

#include <algorithm>

namespace
{
class Targets
{
public:
    Targets(const tinygltf::Model& model, const tinygltf::Primitive& primitive, std::span<const double> weights)
        : model_(model), primitive_(primitive), weights_(weights)
    {
    }

    /// Displaces the first components of each element of `base`, if it has any.
    template <typename Vector>
    Status add(const char* name, uint32_t min_components, std::vector<Vector>& base) const
    {
        constexpr uint32_t kComponents = sizeof(Vector) / sizeof(float);
        std::vector<double> sums; // [kComponents a vertex], made once a target needs them
        for (size_t t = 0; t < std::min(weights_.size(), primitive_.targets.size()) && !base.empty(); ++t)
        {
            const auto accessor = primitive_.targets[t].find(name);
            if (weights_[t] == 0 || accessor == primitive_.targets[t].end())
                continue;
            const Result<FloatArray> moves = readFloats(model_, accessor->second, min_components, kComponents);
            if (!moves)
                return Error{moves.error().code, fmt::format("morph target {}: {}", t, moves.error().message)};
            if (moves->count != base.size())
                return Error{ExitCode::kInvalid, fmt::format("{} of morph target {} has {} elements for {} vertices",
                                                             name, t, moves->count, base.size())};
            sums.resize(base.size() * kComponents);
            for (size_t v = 0; v < base.size(); ++v)
                for (uint32_t c = 0; c < moves->components; ++c)
                    sums[v * kComponents + c] += weights_[t] * double(moves->values[v * moves->components + c]);
        }
        for (size_t i = 0; i < sums.size(); ++i)
        {
            float& value = (&base[i / kComponents].x)[i % kComponents];
            value = float(double(value) + sums[i]);
        }
        return Success{};
    }

private:
    const tinygltf::Model& model_;
    const tinygltf::Primitive& primitive_;
    std::span<const double> weights_;
};
} // namespace

Status applyMorphTargets(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                         std::span<const double> weights, MeshPrimitive& mesh)
{
    const Targets targets(model, primitive, weights);
    const auto statuses = {targets.add("POSITION", 3, mesh.positions), targets.add("NORMAL", 3, mesh.normals),
                           targets.add("TANGENT", 3, mesh.tangents),   targets.add("TEXCOORD_0", 2, mesh.uv0),
                           targets.add("TEXCOORD_1", 2, mesh.uv1),     targets.add("COLOR_0", 3, mesh.colors)};
    for (const Status& status : statuses)
        if (!status)
            return status;
    if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), [](gpu::vec3 p) { return isFinite(p); }))
        return Error{ExitCode::kInvalid, "its morph targets move vertices beyond the range of numbers"};
    return Success{};
}

Result<std::vector<MorphTarget>> readMorphTargets(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                                  size_t count, const MeshPrimitive& mesh)
{
    std::vector<MorphTarget> targets(count);
    const auto read = [&](size_t t, const char* name, bool has_base, std::vector<gpu::vec3>& out) -> Status
    {
        if (!has_base || t >= primitive.targets.size() || !primitive.targets[t].contains(name))
            return Success{};
        const Result<FloatArray> moves = readFloats(model, primitive.targets[t].at(name), 3, 3);
        if (!moves)
            return Error{moves.error().code, fmt::format("morph target {}: {}", t, moves.error().message)};
        if (moves->count != mesh.positions.size())
            return Error{ExitCode::kInvalid, fmt::format("{} of morph target {} has {} elements for {} vertices", name,
                                                         t, moves->count, mesh.positions.size())};
        for (size_t v = 0; v < moves->count; ++v)
            out.push_back({moves->values[3 * v], moves->values[3 * v + 1], moves->values[3 * v + 2]});
        if (!std::all_of(out.begin(), out.end(), [](gpu::vec3 p) { return isFinite(p); }))
            return Error{ExitCode::kInvalid, fmt::format("{} of morph target {} is not finite", name, t)};
        return Success{};
    };
    for (size_t t = 0; t < count; ++t)
        for (const Status& status : {read(t, "POSITION", true, targets[t].positions),
                                     read(t, "NORMAL", !mesh.normals.empty(), targets[t].normals),
                                     read(t, "TANGENT", !mesh.tangents.empty(), targets[t].tangents)})
            if (!status)
                return status.error();
    return targets;
}
