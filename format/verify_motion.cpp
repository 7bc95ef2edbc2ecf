// Chunk MOTN: nodes, bones, clips, and what they set.
#include "format/motion.h"
#include "format/package_verify.h"

#include <algorithm>
#include <numbers>

namespace package
{
namespace
{
namespace fb = lumicut::fb;

bool isFinite(const fb::Double3* v)
{
    return v == nullptr || (std::isfinite(v->x()) && std::isfinite(v->y()) && std::isfinite(v->z()));
}
bool isNonNegative(const fb::Double3* v)
{
    return isFinite(v) && (v == nullptr || (v->x() >= 0 && v->y() >= 0 && v->z() >= 0));
}
bool isFinite(const fb::Double4& v)
{
    return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z()) && std::isfinite(v.w());
}
bool isFinite(const fb::DoubleMatrix* m)
{
    return m == nullptr || (isFinite(m->x()) && isFinite(m->y()) && isFinite(m->z()));
}
bool isUnitQuaternion(const fb::Double4* q)
{
    return q == nullptr || (isFinite(*q) && std::abs(q->x() * q->x() + q->y() * q->y() + q->z() * q->z() +
                                                     q->w() * q->w() - 1) <= 1e-6);
}
bool isIndex(int32_t index, size_t count) // -1: none
{
    return index == -1 || (index >= 0 && uint32_t(index) < count);
}

class MotionVerifier
{
public:
    explicit MotionVerifier(const Contents& contents) : contents_(contents), motion_(*contents.motion) {}

    Status run() const
    {
        for (const auto part :
             {&MotionVerifier::nodes, &MotionVerifier::bones, &MotionVerifier::lights, &MotionVerifier::cameras,
              &MotionVerifier::objects, &MotionVerifier::materials, &MotionVerifier::clips})
            if (Status status = (this->*part)(); !status)
                return status;
        return Success{};
    }

private:
    Status nodes() const
    {
        for (uint32_t i = 0; i < motion_.nodes()->size(); ++i)
        {
            const fb::MotionNode& node = *motion_.nodes()->Get(i);
            if (!isIndex(node.parent(), i))
                return invalid("chunk MOTN: node {} has the parent {}, which does not come before it", i,
                               node.parent());
            if (!isFinite(node.translation()) || !isFinite(node.scale()) || !isFinite(node.matrix()))
                return invalid("chunk MOTN: node {} has a transform that is not finite", i);
            if (!isUnitQuaternion(node.rotation()))
                return invalid("chunk MOTN: node {} has a rotation that is no unit quaternion", i);
            if (uint64_t(node.first_weight()) + node.weight_count() > motion_.weights()->size())
                return invalid("chunk MOTN: node {} has morph weights {} to {}, there are {}", i, node.first_weight(),
                               uint64_t(node.first_weight()) + node.weight_count(), motion_.weights()->size());
        }
        for (uint32_t i = 0; i < motion_.weights()->size(); ++i)
            if (!std::isfinite(motion_.weights()->Get(i)))
                return invalid("chunk MOTN: morph weight {} is not finite", i);
        return Success{};
    }

    Status bones() const
    {
        for (uint32_t i = 0; i < motion_.bones()->size(); ++i)
        {
            const fb::Bone& bone = *motion_.bones()->Get(i);
            if (bone.node() >= motion_.nodes()->size() || !isIndex(bone.shown_by(), motion_.nodes()->size()))
                return invalid("chunk MOTN: bone {} refers to nodes {} and {}, there are {}", i, bone.node(),
                               bone.shown_by(), motion_.nodes()->size());
            if (!isFinite(bone.bind()))
                return invalid("chunk MOTN: bone {} has a bind matrix that is not finite", i);
        }
        return Success{};
    }

    Status lights() const
    {
        constexpr double kRightAngle = std::numbers::pi / 2;
        for (uint32_t i = 0; i < motion_.lights()->size(); ++i)
        {
            const fb::MotionLight& light = *motion_.lights()->Get(i);
            if (light.light() >= contents_.lights.size() || light.node() >= motion_.nodes()->size())
                return invalid("chunk MOTN: light {} refers to light {} of {} in LITE and to node {} of {}", i,
                               light.light(), contents_.lights.size(), light.node(), motion_.nodes()->size());
            if (contents_.lights[light.light()].kind > gpu::kLightDirectional)
                return invalid("chunk MOTN: light {} refers to light {} in LITE, which is no point, spot or "
                               "directional light",
                               i, light.light());
            if (!isNonNegative(light.color()) || !(light.intensity() >= 0) || !std::isfinite(light.intensity()))
                return invalid("chunk MOTN: light {} has a colour or an intensity that is negative or not finite", i);
            for (const double angle : {light.inner_cone(), light.outer_cone()})
                if (!(angle >= 0) || angle > kRightAngle * (1 + 1e-6))
                    return invalid("chunk MOTN: light {} has a cone of {} radians, allowed are 0 to pi / 2", i, angle);
        }
        return Success{};
    }

    Status cameras() const
    {
        for (uint32_t i = 0; i < motion_.cameras()->size(); ++i)
        {
            const fb::MotionCamera& camera = *motion_.cameras()->Get(i);
            if (camera.camera() >= contents_.meta->cameras()->size() || camera.node() >= motion_.nodes()->size())
                return invalid("chunk MOTN: camera {} refers to camera {} of {} in META and to node {} of {}", i,
                               camera.camera(), contents_.meta->cameras()->size(), camera.node(),
                               motion_.nodes()->size());
        }
        return Success{};
    }

    Status objects() const
    {
        const size_t triangle_count = contents_.stored.triangles.size();
        uint64_t next = 0;
        for (uint32_t i = 0; i < motion_.objects()->size(); ++i)
        {
            const fb::MovingObject& object = *motion_.objects()->Get(i);
            if (object.node() >= motion_.nodes()->size() ||
                !isIndex(object.caustic_target(), contents_.caustic_targets.size()))
                return invalid("chunk MOTN: object {} refers to node {} of {} and to caustic target {} of {}", i,
                               object.node(), motion_.nodes()->size(), object.caustic_target(),
                               contents_.caustic_targets.size());
            if (object.triangle_count() == 0 || (i > 0 && object.first_triangle() != next))
                return invalid("chunk MOTN: object {} has {} triangles from {} on, where {} is next", i,
                               object.triangle_count(), object.first_triangle(), next);
            next = uint64_t(object.first_triangle()) + object.triangle_count();
        }
        if (motion_.objects()->size() > 0 && next != triangle_count)
            return invalid("chunk MOTN: the objects' triangles end at {}, chunk TRIS has {}", next, triangle_count);
        return Success{};
    }

    Status materials() const
    {
        for (uint32_t i = 0; i < motion_.materials()->size(); ++i)
        {
            const fb::MotionMaterial& material = *motion_.materials()->Get(i);
            if (material.material() >= contents_.materials.size())
                return invalid("chunk MOTN: emission {} is of material {}, chunk MATL has {}", i, material.material(),
                               contents_.materials.size());
            if (!isNonNegative(material.emissive()) || !(material.strength() >= 0) ||
                !std::isfinite(material.strength()))
                return invalid("chunk MOTN: emission {} is negative or not finite", i);
        }
        return Success{};
    }

    Status clips() const
    {
        for (uint32_t i = 0; i < motion_.clips()->size(); ++i)
        {
            const fb::Clip& clip = *motion_.clips()->Get(i);
            float end = 0;
            for (uint32_t c = 0; c < clip.channels()->size(); ++c)
            {
                const fb::Channel& channel = *clip.channels()->Get(c);
                if (Status status = keys(channel, i, c); !status)
                    return status;
                end = std::max(end, channel.times()->Get(channel.times()->size() - 1));
            }
            if (!std::isfinite(clip.duration()) || clip.duration() < end)
                return invalid("chunk MOTN: clip {} lasts {} s, its last key is at {} s", i, clip.duration(), end);
        }
        return Success{};
    }

    Status keys(const fb::Channel& channel, uint32_t clip, uint32_t number) const
    {
        const Result<uint32_t> width = valuesPerKey(channel);
        if (!width)
            return invalid("chunk MOTN: clip {} channel {} {}", clip, number, width.error().message);
        if (channel.interpolation() > fb::Interpolation::MAX ||
            (channel.target() == fb::ChannelTarget::Visibility && channel.interpolation() != fb::Interpolation::Step))
            return invalid("chunk MOTN: clip {} channel {} has the unknown interpolation {}", clip, number,
                           uint32_t(channel.interpolation()));
        const auto& times = *channel.times();
        const auto& values = *channel.values();
        const uint64_t stride = uint64_t(*width) * (channel.interpolation() == fb::Interpolation::CubicSpline ? 3 : 1);
        if (times.size() == 0 || values.size() != times.size() * stride)
            return invalid("chunk MOTN: clip {} channel {} has {} values for {} keys of {}", clip, number,
                           values.size(), times.size(), stride);
        for (uint32_t i = 0; i < times.size(); ++i)
            if (!std::isfinite(times[i]) || times[i] < 0 || (i > 0 && times[i] <= times[i - 1]))
                return invalid("chunk MOTN: clip {} channel {} key {} is at {} s; times must rise from 0 on", clip,
                               number, i, times[i]);
        if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
            return invalid("chunk MOTN: clip {} channel {} has a value that is not finite", clip, number);
        return Success{};
    }

    /// @return an error that completes "channel 3 ..."
    Result<uint32_t> valuesPerKey(const fb::Channel& channel) const
    {
        const std::optional<ChannelKind> kind = kindOf(channel.target());
        if (!kind)
            return invalid("has the unknown target {}", uint32_t(channel.target()));
        const size_t count = kind->object == ChannelObject::kNode     ? motion_.nodes()->size()
                             : kind->object == ChannelObject::kLight  ? motion_.lights()->size()
                             : kind->object == ChannelObject::kCamera ? motion_.cameras()->size()
                                                                      : contents_.materials.size();
        const uint32_t index = channel.index();
        if (index >= count)
            return invalid("sets a property of object {}, there are {}", index, count);
        using enum fb::ChannelTarget;
        if (kind->object == ChannelObject::kNode)
        {
            const fb::MotionNode& node = *motion_.nodes()->Get(index);
            const bool moves = channel.target() <= Scale;
            if (moves && node.matrix() != nullptr)
                return invalid("moves node {}, which has a matrix", index);
            if (kind->width == 0 && node.weight_count() == 0)
                return invalid("sets morph weights of node {}, which has none", index);
            return kind->width == 0 ? node.weight_count() : kind->width;
        }
        if (channel.target() == CameraYfov || channel.target() == CameraHeight)
        {
            const fb::Camera& camera = *contents_.meta->cameras()->Get(motion_.cameras()->Get(index)->camera());
            if ((camera.orthographic_height() > 0) != (channel.target() == CameraHeight))
                return invalid("sets what camera {} does not have", index);
        }
        if ((channel.target() == MaterialEmissive || channel.target() == MaterialEmissiveStrength) &&
            std::none_of(motion_.materials()->begin(), motion_.materials()->end(),
                         [&](const fb::MotionMaterial* m) { return m->material() == index; }))
            return invalid("sets the emission of material {}, whose factors are missing", index);
        return kind->width;
    }

    const Contents& contents_;
    const fb::Motion& motion_;
};
} // namespace

Status verifyMotion(const Contents& contents)
{
    return contents.motion == nullptr ? Status(Success{}) : MotionVerifier(contents).run();
}

Status verifyMovingVertices(const Contents& contents)
{
    const bool moves = contents.motion != nullptr && contents.motion->objects()->size() > 0;
    const size_t count = contents.moving_vertices.size();
    if (!moves && !(contents.moving_vertices.empty() && contents.influences.empty() && contents.morph_offsets.empty()))
        return invalid("chunk MVTX, MINF or MMRF is there but chunk MOTN has no objects");
    if (count > contents.stored.positions.size())
        return invalid("chunk MVTX: {} vertices, chunk VPOS has {}", count, contents.stored.positions.size());
    for (size_t i = 0; i < count; ++i)
    {
        const gpu::MovingVertex& v = contents.moving_vertices[i];
        const bool last = i + 1 == count;
        const size_t influences_end = last ? contents.influences.size() : (&v)[1].first_influence;
        const size_t morphs_end = last ? contents.morph_offsets.size() : (&v)[1].first_morph;
        if ((i == 0 && (v.first_influence != 0 || v.first_morph != 0)) || influences_end <= v.first_influence ||
            influences_end > contents.influences.size())
            return invalid("chunk MVTX: vertex {} has influences {} to {}, chunk MINF has {}", i, v.first_influence,
                           influences_end, contents.influences.size());
        if (morphs_end < v.first_morph || morphs_end > contents.morph_offsets.size())
            return invalid("chunk MVTX: vertex {} has morph offsets {} to {}, chunk MMRF has {}", i, v.first_morph,
                           morphs_end, contents.morph_offsets.size());
        if (!isFinite(v.position) || !isUnit(v.normal) || !isFinite(v.tangent) || std::abs(v.tangent.w) != 1)
            return invalid("chunk MVTX: vertex {} is not finite, or has a normal or tangent that is no direction", i);
        double sum = 0;
        for (size_t k = v.first_influence; k < influences_end; ++k)
        {
            const gpu::Influence& influence = contents.influences[k];
            if (influence.bone >= contents.motion->bones()->size() || !isWithin(influence.weight, 0, 1))
                return invalid("chunk MINF: entry {} follows bone {} of {} with weight {}", k, influence.bone,
                               contents.motion->bones()->size(), influence.weight);
            sum += influence.weight;
        }
        if (std::abs(sum - 1) > 1e-3)
            return invalid("chunk MVTX: vertex {} has influences that sum to {}, not 1", i, sum);
    }
    for (size_t i = 0; i < contents.morph_offsets.size(); ++i)
    {
        const gpu::MorphOffset& offset = contents.morph_offsets[i];
        if (offset.weight >= contents.motion->weights()->size())
            return invalid("chunk MMRF: entry {} has weight {}, chunk MOTN has {}", i, offset.weight,
                           contents.motion->weights()->size());
        if (!isFinite(offset.position) || !isFinite(offset.normal) || !isFinite(offset.tangent))
            return invalid("chunk MMRF: entry {} is not finite", i);
    }
    return Success{};
}
} // namespace package
