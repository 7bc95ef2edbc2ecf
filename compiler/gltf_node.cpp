#include "compiler/gltf_node.h"

#include <fmt/format.h>

#include <algorithm>

namespace
{
Error invalid(std::string_view text, size_t node)
{
    return {ExitCode::kInvalid, fmt::format("{} (/nodes/{})", text, node)};
}
} // namespace

bool isFiniteTransform(const Transform& t)
{
    const auto finite = [](double v) { return std::isfinite(v); };
    return std::all_of(t.linear.begin(), t.linear.end(), finite) &&
           std::all_of(t.translation.begin(), t.translation.end(), finite);
}

std::optional<Transform> affineTransform(std::span<const double, 16> m)
{
    // Products of matrices in single precision leave a few 1e-7 of their elements there.
    constexpr double kRounding = 1e-5;
    const double w = m[15];
    const double largest_of_row = std::max({std::fabs(m[3]), std::fabs(m[7]), std::fabs(m[11])});
    if (!(std::fabs(w) > kRounding) || !std::isfinite(w) || !(largest_of_row <= kRounding * std::fabs(w)))
        return std::nullopt;
    Transform result{{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
    if (w != 1)
    {
        for (double& element : result.linear)
            element /= w;
        for (double& element : result.translation)
            element /= w;
    }
    return result;
}

Result<Transform> localTransform(const tinygltf::Node& node, size_t index)
{
    Transform result;
    if (!node.matrix.empty())
    {
        const std::optional<Transform> affine =
            node.matrix.size() == 16 ? affineTransform(std::span(node.matrix).first<16>()) : std::nullopt;
        if (!affine)
            return invalid("a node's matrix is not an affine 4 x 4 matrix: its last row must be 0 0 0 1", index);
        result = *affine;
    }
    else
    {
        const auto& t = node.translation;
        const auto& r = node.rotation;
        const auto& s = node.scale;
        if ((!t.empty() && t.size() != 3) || (!r.empty() && r.size() != 4) || (!s.empty() && s.size() != 3))
            return invalid("a node's translation, rotation or scale has a wrong number of values", index);
        result = fromTranslationRotationScale(
            t.empty() ? std::array<double, 3>{0, 0, 0} : std::array<double, 3>{t[0], t[1], t[2]},
            r.empty() ? std::array<double, 4>{0, 0, 0, 1} : std::array<double, 4>{r[0], r[1], r[2], r[3]},
            s.empty() ? std::array<double, 3>{1, 1, 1} : std::array<double, 3>{s[0], s[1], s[2]});
    }
    if (!isFiniteTransform(result))
        return invalid("a node's transform is not finite", index);
    return result;
}

NodeTransforms::NodeTransforms(const tinygltf::Model& model)
    : model_(model), parents_(model.nodes.size(), kNoParent), known_(model.nodes.size())
{
    for (size_t node = 0; node < model.nodes.size(); ++node)
        for (const int child : model.nodes[node].children)
            if (child >= 0 && size_t(child) < parents_.size() && parents_[size_t(child)] == kNoParent)
                parents_[size_t(child)] = node;
}

Result<Transform> NodeTransforms::toWorld(int node)
{
    if (node < 0 || size_t(node) >= parents_.size())
        return Error{ExitCode::kInvalid, fmt::format("node {} does not exist", node)};
    std::vector<size_t> unknown;
    for (size_t at = size_t(node); at != kNoParent && !known_[at]; at = parents_[at])
    {
        if (unknown.size() == parents_.size())
            return invalid("a node is its own ancestor", at);
        unknown.push_back(at);
    }
    for (auto at = unknown.rbegin(); at != unknown.rend(); ++at)
    {
        const Result<Transform> local = localTransform(model_.nodes[*at], *at);
        if (!local)
            return local.error();
        known_[*at] = parents_[*at] == kNoParent ? *local : *known_[parents_[*at]] * *local;
    }
    return *known_[size_t(node)];
}
