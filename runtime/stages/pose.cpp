#include "runtime/stages/pose.h"

#include "runtime/stages/tree.h"

#include <algorithm>
#include <cstring>

namespace
{
template <typename T>
Buffer uploadOrOne(const Device& device, std::string_view name, std::span<const T> data)
{
    const T none{};
    return device.upload(name, data.empty() ? std::span<const T>(&none, 1) : data);
}

/// The moving part of a hierarchy: what its leaves and nodes hang on.
struct MovingTree
{
    std::vector<gpu::PosedLeaf> leaves;
    std::vector<uint32_t> parents; // by moving node; that of node 0 is never read
};

MovingTree movingTree(const package::Package& package)
{
    const auto nodes = package.bvhNodes();
    const uint32_t first = package.firstMovingNode();
    MovingTree tree{.leaves = {}, .parents = std::vector<uint32_t>(nodes.size() - first)};
    for (uint32_t node = 0; node < nodes.size(); ++node)
    {
        if (node > 0 && node < first) // the root alone of those before may have moving children
            node = first;
        if (node >= nodes.size())
            break;
        const std::array children{nodes[node].child.x, nodes[node].child.y, nodes[node].child.z, nodes[node].child.w};
        for (uint32_t i = 0; i < gpu::kBvhWidth; ++i)
        {
            const uint32_t link = gpu::kBvhWidth * node + i;
            if (children[i] == gpu::kNone)
                continue;
            if ((children[i] & gpu::kLeafBit) == 0)
            {
                if (children[i] >= first)
                    tree.parents[children[i] - first] = link;
            }
            else if ((children[i] & gpu::kLeafFirstMask) >= package.firstMovingSlot())
                tree.leaves.push_back({link, children[i]});
        }
    }
    return tree;
}

std::vector<gpu::PosedEmitter> movingEmitters(const package::Package& package)
{
    std::vector<gpu::PosedEmitter> emitters;
    const auto slots = package.bvhTriangles();
    for (uint32_t slot = package.firstMovingSlot(); slot < slots.size(); ++slot)
        if (const uint32_t light = package.triangles()[slots[slot].triangle].light; light != gpu::kNone)
            emitters.push_back({light, slot});
    return emitters;
}

std::vector<gpu::PosedTarget> movingTargets(const package::Package& package)
{
    std::vector<gpu::PosedTarget> targets;
    const auto* objects = package.motion()->objects();
    for (uint32_t i = 0; i < objects->size(); ++i)
        if (const int32_t target = objects->Get(i)->caustic_target(); target >= 0)
            targets.push_back({uint32_t(target), package.movingRanges()[i].root_node});
    return targets;
}

std::vector<std::vector<uint32_t>> emittersByMaterial(const package::Package& package)
{
    std::vector<std::vector<uint32_t>> lights(package.materials().size());
    std::vector<bool> seen(package.lights().size()); // spatial splits store a triangle in several slots
    for (const gpu::BvhTriangle& t : package.bvhTriangles())
        if (const uint32_t light = package.triangles()[t.triangle].light; light != gpu::kNone && !seen[light])
        {
            seen[light] = true;
            lights[t.material].push_back(light);
        }
    return lights;
}

/// Whether an animation can make a scale's sign another. Cubic splines may go beyond their keys.
bool scalesChangeSign(const package::Package& package)
{
    namespace fb = lumicut::fb;
    const auto canMirror = [&](const fb::Channel* channel)
    {
        if (channel->target() != fb::ChannelTarget::Scale)
            return false;
        const fb::Double3* const rest = package.motion()->nodes()->Get(channel->index())->scale();
        return channel->interpolation() == fb::Interpolation::CubicSpline ||
               (rest != nullptr && std::min({rest->x(), rest->y(), rest->z()}) <= 0) ||
               std::ranges::any_of(*channel->values(), [](float scale) { return scale <= 0; });
    };
    return std::ranges::any_of(*package.motion()->clips(),
                               [&](const fb::Clip* clip) { return std::ranges::any_of(*clip->channels(), canMirror); });
}

/// Which moving triangles the package has wound as mirrored ones, by slot.
std::vector<uint32_t> mirroredAtRest(const package::Package& package)
{
    const package::Pose rest = package::poseAtRest(package);
    const auto vertices = package.movingVertices();
    std::vector<bool> mirrored(vertices.size());
    for (uint32_t v = 0; v < vertices.size(); ++v)
        mirrored[v] = package::isMirrored(package, rest, v);
    std::vector<uint32_t> triangles;
    for (const gpu::BvhTriangle& slot : package.bvhTriangles().subspan(package.firstMovingSlot()))
    {
        const gpu::uvec3& v = package.triangles()[slot.triangle].vertices;
        const uint32_t first = package.firstMovingVertex();
        triangles.push_back(mirrored[v.x - first] + mirrored[v.y - first] + mirrored[v.z - first] >= 2 ? 1 : 0);
    }
    return triangles;
}

bool sameBytes(const auto& a, const auto& b)
{
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

bool sameGeometry(const package::Pose& a, const package::Pose& b)
{
    return sameBytes(a.bones, b.bones) && sameBytes(a.weights, b.weights);
}

} // namespace

PoseStage::PoseStage(const Device& device, SceneGpu& scene, const package::Package& package, double drift)
    : scene_(scene), bounds_(package),
      tree_(package.bvhNodes(), package.firstMovingNode(), package.movingRanges(), drift),
      deform_(device.kernel("pose/deform")), refit_(device.kernel("pose/refit", {climbConstant(device)})),
      follow_(device.kernel("pose/follow")), shapes_(package)
{
    const auto* motion = package.motion();
    check(motion != nullptr, "a package without motion has no poses");
    std::vector<gpu::MovingVertex> vertices(package.movingVertices().begin(), package.movingVertices().end());
    vertices.push_back({.first_influence = uint32_t(package.influences().size()),
                        .first_morph = uint32_t(package.morphOffsets().size())});
    vertices_ = device.upload<gpu::MovingVertex>("pose.vertices", vertices);
    influences_ = uploadOrOne(device, "pose.influences", package.influences());
    morphs_ = uploadOrOne(device, "pose.morphs", package.morphOffsets());
    bones_ = device.array<gpu::BoneMatrix>("pose.bones", motion->bones()->size());
    weights_ = device.array<float>("pose.weights", motion->weights()->size());
    positions_ = device.array<gpu::vec3>("pose.positions", vertices.size() - 1);
    const MovingTree tree = movingTree(package);
    leaves_ = uploadOrOne<gpu::PosedLeaf>(device, "pose.leaves", tree.leaves);
    parents_ = uploadOrOne<uint32_t>(device, "pose.parents", tree.parents);
    arrivals_ = device.array<uint32_t>("pose.arrivals", tree.parents.size());
    if (tree_.canChange())
    {
        hang_ = device.kernel("pose/hang");
        objects_ = device.array<gpu::PosedObject>("pose.objects", package.movingRanges().size());
    }
    if (scalesChangeSign(package))
    {
        wind_ = device.kernel("pose/wind");
        mirrored_ = uploadOrOne<uint32_t>(device, "pose.mirrored", mirroredAtRest(package));
    }
    const auto emitters = movingEmitters(package);
    const auto targets = movingTargets(package);
    emitters_ = uploadOrOne<gpu::PosedEmitter>(device, "pose.emitters", emitters);
    targets_ = uploadOrOne<gpu::PosedTarget>(device, "pose.targets", targets);
    params_ = {.vertex_count = uint32_t(vertices.size() - 1),
               .first_vertex = package.firstMovingVertex(),
               .leaf_count = uint32_t(tree.leaves.size()),
               .first_slot = package.firstMovingSlot(),
               .first_node = package.firstMovingNode(),
               .emitter_count = uint32_t(emitters.size()),
               .target_count = uint32_t(targets.size()),
               .object_count = uint32_t(package.movingRanges().size()),
               .slot_count = uint32_t(package.bvhTriangles().size()) - package.firstMovingSlot()};
    rest_.assign(package.materials().begin(), package.materials().end());
    emitters_of_ = emittersByMaterial(package);
}

void PoseStage::record(Recorder& rec, const package::Pose& pose)
{
    const auto scope = rec.scope("pose");
    const bool moves = !last_ || !sameGeometry(*last_, pose);
    if (moves)
    {
        uploadBones(rec, pose);
        wind(rec);
        hangObjects(rec, pose);
    }
    if (moves || moved_) // once more after the last move: then what was is what is
        refit(rec);
    changes_.restart(scene_.lights());
    setMaterials(rec, pose);
    changeLights(pose);
    if (moves)
        shapes_.change(pose, changes_);
    scene_.setLights(rec, changes_.changed());
    if (moves)
        scene_.noteMove();
    moved_ = moves;
    last_ = pose;
}

void PoseStage::uploadBones(Recorder& rec, const package::Pose& pose)
{
    rec.write(bones_, 0, std::as_bytes(std::span(pose.bones)));
    rec.write(weights_, 0, std::as_bytes(std::span(pose.weights)));
    rec.run(deform_, params_.vertex_count, params_,
            {{"MovingVertices", vertices_},
             {"Influences", influences_},
             {"MorphOffsets", morphs_},
             {"Bones", bones_},
             {"Weights", weights_},
             {"Positions", positions_},
             {"Vertices", scene_.buffer(gpu::kVertexAttributesBinding)}});
}

void PoseStage::wind(Recorder& rec) const
{
    if (!wind_)
        return;
    rec.run(*wind_, params_.slot_count, params_,
            {{"MovingVertices", vertices_},
             {"Influences", influences_},
             {"Bones", bones_},
             {"Mirrored", mirrored_},
             {"Slots", scene_.buffer(gpu::kBvhTrianglesBinding)},
             {"Triangles", scene_.buffer(gpu::kTrianglesBinding)}});
}

void PoseStage::hangObjects(Recorder& rec, const package::Pose& pose)
{
    if (!tree_.canChange())
        return;
    const std::span<const gpu::PosedObject> hung = tree_.update(bounds_.at(pose));
    if (hung.empty())
        return;
    rec.write(objects_, 0, std::as_bytes(hung));
    rec.run(*hang_, params_.object_count, params_,
            {{"Objects", objects_}, {"Nodes", scene_.buffer(gpu::kBvhNodesBinding)}, {"Parents", parents_}});
}

void PoseStage::refit(Recorder& rec) const
{
    rec.clear(arrivals_);
    rec.run(refit_, params_.leaf_count, params_,
            {{"Positions", positions_},
             {"Triangles", scene_.buffer(gpu::kTrianglesBinding)},
             {"Leaves", leaves_},
             {"Parents", parents_},
             {"Slots", scene_.buffer(gpu::kBvhTrianglesBinding)},
             {"LastCorners", scene_.lastCorners()},
             {"Nodes", scene_.buffer(gpu::kBvhNodesBinding)},
             {"Arrivals", arrivals_}});
    rec.run(follow_, std::max({params_.emitter_count, params_.target_count, 1u}), params_,
            {{"Emitters", emitters_},
             {"Targets", targets_},
             {"Slots", scene_.buffer(gpu::kBvhTrianglesBinding)},
             {"Nodes", scene_.buffer(gpu::kBvhNodesBinding)},
             {"Lights", scene_.buffer(gpu::kLightsBinding)},
             {"CausticTargets", scene_.buffer(gpu::kCausticTargetsBinding)},
             {"Info", scene_.buffer(gpu::kSceneInfoBinding)}});
}

/// Lights that the last pose had likewise are left alone: each change ends what is accumulated.
void PoseStage::changeLights(const package::Pose& pose)
{
    for (size_t i = 0; i < pose.lights.size(); ++i)
    {
        const package::PosedLight& light = pose.lights[i];
        if (!last_ || std::memcmp(&light.light, &last_->lights[i].light, sizeof(light.light)) != 0)
            changes_.of(light.index) = light.light;
    }
}

/// Its triangles that are lights shine as it does.
void PoseStage::setMaterial(Recorder& rec, uint32_t index, const gpu::Material& before, const gpu::Material& now)
{
    if (std::memcmp(&before, &now, sizeof(now)) == 0)
        return;
    scene_.setMaterial(rec, index, now);
    if (std::memcmp(&before.emission, &now.emission, sizeof(now.emission)) != 0)
        for (const uint32_t light : emitters_of_[index])
            changes_.of(light).emission = now.emission;
}

/// A clip's materials; those of the clip before that it does not set are again as in the package.
void PoseStage::setMaterials(Recorder& rec, const package::Pose& pose)
{
    const auto in = [](const package::Pose& p, uint32_t index) -> const gpu::Material*
    {
        const auto found = std::ranges::find(p.materials, index, &package::PosedMaterial::index);
        return found == p.materials.end() ? nullptr : &found->material;
    };
    const auto set = [&](uint32_t index, const gpu::Material& now)
    {
        const gpu::Material* before = last_ ? in(*last_, index) : nullptr;
        setMaterial(rec, index, before != nullptr ? *before : rest_[index], now);
    };
    for (const package::PosedMaterial& material : pose.materials)
        set(material.index, material.material);
    if (last_)
        for (const package::PosedMaterial& material : last_->materials)
            if (in(pose, material.index) == nullptr)
                set(material.index, rest_[material.index]);
}
