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
