#include "format/pose.h"

#include "format/pose_state.h"
#include "format/spot_cone.h"
#include "format/transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace package
{
namespace
{
namespace fb = lumicut::fb;

/// Of rows.
Transform toTransform(const fb::DoubleMatrix& m)
{
    const fb::Double4 &x = m.x(), &y = m.y(), &z = m.z();
    return {{x.x(), y.x(), z.x(), x.y(), y.y(), z.y(), x.z(), y.z(), z.z()}, {x.w(), y.w(), z.w()}};
}

} // namespace

class Poser::Tables
{
public:
    explicit Tables(const Package& package) : package_(package), motion_(*package.motion()), state_(package)
    {
        unit_ = package.meta().unit();
        if (const fb::Vec3d* const o = package.meta().origin())
            origin_ = {o->x(), o->y(), o->z()};
        for (const fb::MotionNode* node : *motion_.nodes())
            nodes_.push_back(
                {.parent = node->parent(),
                 .matrix = node->matrix() == nullptr ? std::nullopt : std::optional(toTransform(*node->matrix()))});
        for (const fb::Bone* bone : *motion_.bones())
            bones_.push_back(
                {.node = bone->node(),
                 .shown_by = bone->shown_by(),
                 .bind = bone->bind() == nullptr ? std::nullopt : std::optional(toTransform(*bone->bind()))});
        to_world_.resize(nodes_.size());
        shown_.resize(nodes_.size());
    }

    PoseState& state() { return state_; }

    void fill(Pose& pose)
    {
        place();
        pose.bones.clear();
        for (const Bone& bone : bones_)
            pose.bones.push_back(boneMatrix(bone));
        pose.weights.clear();
        for (const double weight : state_.weights())
            pose.weights.push_back(narrow(weight));
        pose.lights.clear();
        for (uint32_t i = 0; i < state_.lights().size(); ++i)
            pose.lights.push_back(posedLight(i));
        pose.cameras.clear();
        for (uint32_t i = 0; i < state_.cameras().size(); ++i)
            pose.cameras.push_back(posedCamera(i));
        pose.materials.clear();
        for (const MaterialState& material : state_.materials())
            pose.materials.push_back({material.index, material.material});
    }

private:
    struct Node
    {
        int32_t parent; // -1: none
        std::optional<Transform> matrix;
    };
    struct Bone
    {
        uint32_t node;
        int32_t shown_by; // -1: always
        std::optional<Transform> bind;
    };

    /// World transforms, and what is visible: parents come first.
    void place()
    {
        for (uint32_t i = 0; i < nodes_.size(); ++i)
        {
            const Node& node = nodes_[i];
            const NodeState& state = state_.nodes()[i];
            const Transform local = node.matrix
                                        ? *node.matrix
                                        : fromTranslationRotationScale(state.translation, state.rotation, state.scale);
            const bool root = node.parent < 0;
            to_world_[i] = root ? local : to_world_[uint32_t(node.parent)] * local;
            shown_[i] = !state.hidden && (root || shown_[uint32_t(node.parent)]);
        }
    }

    Vec3d inPackage(const Vec3d& p) const { return (p - origin_) * (1 / unit_); }

    gpu::BoneMatrix boneMatrix(const Bone& bone) const
    {
        if (bone.shown_by >= 0 && !shown_[uint32_t(bone.shown_by)])
            return {};
        const Transform& world = to_world_[bone.node];
        const Transform m = bone.bind ? world * *bone.bind : world;
        const Vec3d t = inPackage({m.translation[0], m.translation[1], m.translation[2]});
        const auto row = [&](size_t r, double translation) -> gpu::vec4
        {
            return {narrow(m.linear[r] / unit_), narrow(m.linear[3 + r] / unit_), narrow(m.linear[6 + r] / unit_),
                    narrow(translation)};
        };
        return {row(0, t.x), row(1, t.y), row(2, t.z)};
    }

    PosedLight posedLight(uint32_t number) const
    {
        const fb::MotionLight& light = *motion_.lights()->Get(number);
        const LightState& state = state_.lights()[number];
        const Transform& world = to_world_[light.node()];
        PosedLight posed{light.light(), package_.lights()[light.light()]};
        const bool directional = posed.light.kind == gpu::kLightDirectional;
        const double scale = shown_[light.node()] ? std::max(0.0, state.intensity) /
                                                        (directional ? 1 : unit_ * unit_) // distances have another unit
                                                  : 0;
        const auto channel = [&](size_t i) { return narrow(std::max(0.0, state.color[i] * scale)); };
        posed.light.emission = {channel(0), channel(1), channel(2)};
        posed.light.p0 = narrow(inPackage(world.point({})));
        posed.light.p1 = directionOr(world.vector({0, 0, -1}), {0, 0, -1});
        if (posed.light.kind == gpu::kLightSpot)
        {
            const double outer = std::clamp(state.outer_cone, 0.0, std::numbers::pi / 2);
            posed.light.p2 = spotCone(float(std::clamp(state.inner_cone, 0.0, outer)), float(outer));
        }
        return posed;
    }

    PosedCamera posedCamera(uint32_t number) const
    {
        constexpr double kNarrowest = 1e-3, kWidest = 3.14; // radians: of 0 and of pi there is no picture
        const fb::MotionCamera& camera = *motion_.cameras()->Get(number);
        const CameraState& state = state_.cameras()[number];
        const Transform& world = to_world_[camera.node()];
        PosedCamera posed{.index = camera.camera()};
        posed.position = narrow(inPackage(world.point({})));
        const Vec3d forward = unitOrZero(world.vector({0, 0, -1}));
        const Vec3d up = unitOrZero(world.vector({0, 1, 0}));
        posed.forward = directionOr(forward, {0, 0, -1});
        const Vec3d f = toDouble(posed.forward);
        const Vec3d other = std::fabs(f.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
        posed.up = directionOr(up - f * dot(up, f), toFloat(unitOrZero(other - f * dot(other, f))));
        if (state.height > 0)
            posed.orthographic_height = narrow(std::max(state.height / unit_, 1e-30));
        else
            posed.vertical_fov = narrow(std::clamp(state.yfov, kNarrowest, kWidest));
        return posed;
    }

    const Package& package_;
    const fb::Motion& motion_;
    PoseState state_;
    Vec3d origin_;
    double unit_ = 1;
    std::vector<Node> nodes_;
    std::vector<Bone> bones_;
    std::vector<Transform> to_world_; // by node
    std::vector<bool> shown_;         // by node
};

Poser::Poser(const Package& package) : tables_(std::make_unique<Tables>(package)) {}
Poser::~Poser() = default;

const Pose& Poser::at(std::optional<uint32_t> clip, double seconds)
{
    PoseState& state = tables_->state();
    state.rest();
    for (uint32_t i = 0; i < state.clipCount(); ++i)
        if (!clip || *clip == i)
            state.apply(i, seconds);
    tables_->fill(pose_);
    return pose_;
}

const Pose& Poser::atRest()
{
    tables_->state().rest();
    tables_->fill(pose_);
    return pose_;
}

Pose poseAt(const Package& package, std::optional<uint32_t> clip, double seconds)
{
    return Poser(package).at(clip, seconds);
}

Pose poseAtRest(const Package& package)
{
    return Poser(package).atRest();
}

gpu::vec3 posedPosition(const Package& package, const Pose& pose, uint32_t vertex)
{
    const auto vertices = package.movingVertices();
    const bool last = vertex + 1 == vertices.size();
    const size_t influences_end = last ? package.influences().size() : vertices[vertex + 1].first_influence;
    const size_t morphs_end = last ? package.morphOffsets().size() : vertices[vertex + 1].first_morph;
    gpu::vec3 p = vertices[vertex].position;
    for (size_t k = vertices[vertex].first_morph; k < morphs_end; ++k)
    {
        const gpu::MorphOffset& morph = package.morphOffsets()[k];
        const float weight = pose.weights[morph.weight];
        p = {p.x + weight * morph.position.x, p.y + weight * morph.position.y, p.z + weight * morph.position.z};
    }
    gpu::vec3 sum{};
    for (size_t k = vertices[vertex].first_influence; k < influences_end; ++k)
    {
        const gpu::Influence& influence = package.influences()[k];
        const gpu::BoneMatrix& m = pose.bones[influence.bone];
        const auto row = [&](const gpu::vec4& r)
        { return influence.weight * (r.x * p.x + r.y * p.y + r.z * p.z + r.w); };
        sum = {sum.x + row(m.x), sum.y + row(m.y), sum.z + row(m.z)};
    }
    return sum;
}

bool isMirrored(const Package& package, const Pose& pose, uint32_t vertex)
{
    const auto vertices = package.movingVertices();
    const bool last = vertex + 1 == vertices.size();
    const size_t end = last ? package.influences().size() : vertices[vertex + 1].first_influence;
    std::array<Vec3d, 3> rows{};
    for (size_t k = vertices[vertex].first_influence; k < end; ++k)
    {
        const gpu::Influence& influence = package.influences()[k];
        const gpu::BoneMatrix& m = pose.bones[influence.bone];
        rows[0] = rows[0] + Vec3d{m.x.x, m.x.y, m.x.z} * influence.weight;
        rows[1] = rows[1] + Vec3d{m.y.x, m.y.y, m.y.z} * influence.weight;
        rows[2] = rows[2] + Vec3d{m.z.x, m.z.y, m.z.z} * influence.weight;
    }
    return dot(rows[0], cross(rows[1], rows[2])) < 0;
}
} // namespace package
