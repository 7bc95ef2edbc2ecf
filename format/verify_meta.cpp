// Bounds, cameras, names, caustic targets: the contents of META.
#include "format/package_verify.h"

#include <numbers>

namespace package
{
namespace
{
gpu::vec3 toVec3(const lumicut::fb::Vec3& v)
{
    return {v.x(), v.y(), v.z()};
}

Status verifyCamera(const lumicut::fb::Camera& camera, uint32_t index)
{
    if (!camera.position() || !camera.forward() || !camera.up())
        return invalid("chunk META: camera {} lacks its position, forward or up vector", index);
    const gpu::vec3 forward = toVec3(*camera.forward());
    const gpu::vec3 up = toVec3(*camera.up());
    if (!isFinite(toVec3(*camera.position())))
        return invalid("chunk META: camera {} has a position that is not finite", index);
    if (!isUnit(forward) || !isUnit(up) || std::abs(dot(forward, up)) > 1e-3f)
        return invalid("chunk META: camera {}: its forward and up vectors are not orthonormal", index);

    const float fov = camera.vertical_fov();
    const float height = camera.orthographic_height();
    const bool perspective = fov > 0 && fov < std::numbers::pi_v<float> && height == 0;
    const bool orthographic = height > 0 && std::isfinite(height) && fov == 0;
    if (!perspective && !orthographic)
        return invalid("chunk META: camera {} has a field of view of {} radians and an orthographic height of {}; one "
                       "must be 0, the other positive and a field of view below pi",
                       index, fov, height);
    const float near_plane = camera.near_plane();
    const float far_plane = camera.far_plane();
    if (!(near_plane >= 0) || !std::isfinite(near_plane) || !std::isfinite(far_plane) ||
        !(far_plane == 0 || far_plane > near_plane))
        return invalid("chunk META: camera {} has its near plane at {} and its far plane at {}; allowed are 0 or more "
                       "for the first, and more than that or 0, for none, for the second",
                       index, near_plane, far_plane);
    return Success{};
}

/// Positions in the source are computed with these, and speeds in metres.
Status verifyFrame(const lumicut::fb::Meta& meta)
{
    const lumicut::fb::Vec3d* const origin = meta.origin();
    if (origin && !(std::isfinite(origin->x()) && std::isfinite(origin->y()) && std::isfinite(origin->z())))
        return invalid("chunk META: the origin is not finite");
    if (!std::isfinite(meta.unit()) || meta.unit() <= 0)
        return invalid("chunk META: the unit of length is {} m, allowed are positive finite numbers", meta.unit());
    return Success{};
}
} // namespace

Status verifyMeta(const Contents& contents)
{
    const lumicut::fb::Meta& meta = *contents.meta;
    const gpu::vec3 low = toVec3(*meta.bounds_min());
    const gpu::vec3 high = toVec3(*meta.bounds_max());
    if (!isFinite(low) || !isFinite(high) || low.x > high.x || low.y > high.y || low.z > high.z)
        return invalid("chunk META: the scene bounds are not finite or upside down");
    if (Status frame = verifyFrame(meta); !frame)
        return frame;
    if (meta.cameras()->size() == 0)
        return invalid("chunk META: there is no camera");
    for (uint32_t i = 0; i < meta.cameras()->size(); ++i)
    {
        if (Status camera = verifyCamera(*meta.cameras()->Get(i), i); !camera)
            return camera;
    }
    if (meta.material_names()->size() != contents.materials.size())
        return invalid("chunk META: {} material names for {} materials", meta.material_names()->size(),
                       contents.materials.size());
    return Success{};
}

Status verifyCausticTargets(const Contents& contents)
{
    for (size_t i = 0; i < contents.caustic_targets.size(); ++i)
    {
        const gpu::CausticTarget& target = contents.caustic_targets[i];
        if (!isFinite(target.center) || !std::isfinite(target.radius) || target.radius <= 0)
            return invalid("chunk CTGT: target {} is no finite sphere", i);
    }
    return Success{};
}
} // namespace package
