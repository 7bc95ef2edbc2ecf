// Geometry at a pose: triangles where double precision puts them, boxes that fit, hits as in a fresh scene, what follows.
#include "runtime/stages/pose.h"
#include "tests/compiler/posed_package.h"
#include "tests/stages/brute_force.h"
#include "tests/stages/moving_scene.h"
#include "tests/stages/ray_test.h"

#include <algorithm>
#include <cmath>

namespace
{
class Poses : public Rays
{
protected:
    Poses()
    {
        auto package = package::Package::open(source_.package());
        check(bool(package), "{}", package ? "" : package.error().message);
        package_.emplace(std::move(*package));
        auto scene = SceneGpu::create(device(), *package_);
        check(bool(scene), "{}", scene ? "" : scene.error().message);
        scene_ = std::move(*scene);
        stage_.emplace(device(), *scene_, *package_);
    }

    package::Pose show(double seconds)
    {
        package::Pose pose = package::poseAt(*package_, 0, seconds);
        Recorder rec(device());
        rec.begin(scene_->descriptorSet());
        stage_->record(rec, pose);
        rec.submitAndWait();
        return pose;
    }

    template <typename T>
    std::vector<T> sceneBuffer(uint32_t binding, size_t count) const
    {
        return device().download<T>(scene_->buffer(binding), count);
    }
    /// It has several bones or a morph target: its facets' normals are not those of the facets alone.
    bool isBent(uint32_t vertex) const
    {
        if (vertex < package_->firstMovingVertex())
            return false;
        const auto moving = package_->movingVertices();
        const uint32_t i = vertex - package_->firstMovingVertex();
        const bool last = i + 1 == moving.size();
        return (last ? package_->influences().size() : moving[i + 1].first_influence) - moving[i].first_influence > 1 ||
               (last ? package_->morphOffsets().size() : moving[i + 1].first_morph) > moving[i].first_morph;
    }
    std::vector<gpu::BvhTriangle> slots() const
    {
        return sceneBuffer<gpu::BvhTriangle>(gpu::kBvhTrianglesBinding, package_->bvhTriangles().size());
    }

    MovingScene source_;
    std::optional<package::Package> package_;
    std::unique_ptr<SceneGpu> scene_;
    std::optional<PoseStage> stage_;
};

std::array<gpu::vec3, 3> corners(const gpu::BvhTriangle& t)
{
    return {t.v0, t.v1, t.v2};
}

bool equal(gpu::vec3 a, gpu::vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

TEST_F(Poses, PutTrianglesWhereDoublePrecisionDoes)
{
    const std::vector<gpu::BvhTriangle> before = slots();
    for (const double seconds : {0.0, 0.37, 0.8, 1.5, 2.0})
    {
        const std::vector<Vec3d> moved = movedVertices(*package_, show(seconds));
        const std::vector<gpu::BvhTriangle> after = slots();
        for (uint32_t slot = 0; slot < after.size(); ++slot)
        {
            const gpu::uvec3 vertices = package_->triangles()[after[slot].triangle].vertices;
            const std::array indices{vertices.x, vertices.y, vertices.z};
            for (size_t i = 0; i < 3; ++i)
            {
                const gpu::vec3 corner = corners(after[slot])[i];
                if (slot < package_->firstMovingSlot())
                {
                    ASSERT_TRUE(equal(corner, corners(before[slot])[i])) << slot;
                    continue;
                }
                // A dozen roundings of numbers below 4: products of bones and positions.
                const Vec3d right = moved[indices[i] - package_->firstMovingVertex()];
                ASSERT_LT(length(toDouble(corner) - right), 12 * 4 * std::ldexp(1.0, -24)) << seconds << " " << slot;
            }
        }
    }
}

struct Box
{
    std::array<double, 3> low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};

    void include(gpu::vec3 p)
    {
        const std::array<double, 3> at{p.x, p.y, p.z};
        for (size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], at[axis]);
            high[axis] = std::max(high[axis], at[axis]);
        }
    }
    void include(const Box& other)
    {
        for (size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], other.low[axis]);
            high[axis] = std::max(high[axis], other.high[axis]);
        }
    }
};

TEST_F(Poses, FitBoxesToWhatIsBelow)
{
    show(0.2);
    show(1.3); // a box is hidden by now
    const std::vector<gpu::BvhTriangle> triangles = slots();
    const auto nodes = sceneBuffer<gpu::BvhNode>(gpu::kBvhNodesBinding, package_->bvhNodes().size());
    std::vector<Box> boxes(nodes.size()); // of all children
    for (uint32_t node = uint32_t(nodes.size()); node-- > 0;)
        for (uint32_t i = 0; i < gpu::kBvhWidth; ++i)
        {
            const uint32_t child = (&nodes[node].child.x)[i];
            if (child == gpu::kNone)
                continue;
            Box right;
            bool moves = child >= package_->firstMovingNode();
            if ((child & gpu::kLeafBit) == 0)
                right = boxes[child];
            else
            {
                const uint32_t first = child & gpu::kLeafFirstMask;
                const uint32_t count = (child >> gpu::kLeafCountShift & gpu::kLeafCountMask) + 1;
                moves = first >= package_->firstMovingSlot();
                for (uint32_t slot = first; slot < first + count; ++slot)
                    for (const gpu::vec3 corner : corners(triangles[slot]))
                        if (!equal(triangles[slot].v0, triangles[slot].v1)) // else it is hidden
                            right.include(corner);
            }
            const auto plane = [&](const gpu::vec4& planes) { return double((&planes.x)[i]); };
            const gpu::BvhNode& n = nodes[node];
            Box box;
            box.low = {plane(n.min_x), plane(n.min_y), plane(n.min_z)};
            box.high = {plane(n.max_x), plane(n.max_y), plane(n.max_z)};
            boxes[node].include(box);
            for (size_t axis = 0; moves && axis < 3; ++axis)
                if (right.low[0] <= right.high[0]) // nothing is rounded: both are corners
                {
                    EXPECT_EQ(box.low[axis], right.low[axis]) << node << " " << i;
                    EXPECT_EQ(box.high[axis], right.high[axis]) << node << " " << i;
                }
                else
                    EXPECT_GT(box.low[axis], box.high[axis]) << node << " " << i;
        }
    const auto info = sceneBuffer<gpu::SceneInfo>(gpu::kSceneInfoBinding, 1)[0];
    EXPECT_EQ(info.bounds_max.y, float(boxes[0].high[1]));
    EXPECT_EQ(info.bounds_min.x, float(boxes[0].low[0]));
}

TEST_F(Poses, KeepWhereTrianglesWere)
{
    const auto last = [&]
    {
        return device().download<gpu::TriangleCorners>(scene_->lastCorners(),
                                                       package_->bvhTriangles().size() - package_->firstMovingSlot());
    };
    const auto expectLast = [&](const std::vector<gpu::BvhTriangle>& right)
    {
        const std::vector<gpu::TriangleCorners> kept = last();
        for (size_t i = 0; i < kept.size(); ++i)
            ASSERT_TRUE(equal(kept[i].v0, right[package_->firstMovingSlot() + i].v0) &&
                        equal(kept[i].v1, right[package_->firstMovingSlot() + i].v1) &&
                        equal(kept[i].v2, right[package_->firstMovingSlot() + i].v2));
    };
    expectLast(slots()); // at rest
    show(0.5);
    const auto first = slots();
    show(0.6);
    expectLast(first);
    const auto second = slots();
    const SceneVersion version = scene_->version();
    show(0.6); // it stands
    expectLast(second);
    EXPECT_EQ(scene_->version(), version);
    show(0.6);
    EXPECT_EQ(scene_->version(), version);
    show(0.7);
    EXPECT_NE(scene_->version(), version);
    expectLast(second);
}

TEST_F(Poses, GiveTheHitsOfAllTriangles)
{
    Random random(5);
    for (const double seconds : {0.45, 1.9})
    {
        show(seconds);
        const std::vector<gpu::BvhTriangle> triangles = slots();
        std::vector<gpu::Ray> rays;
        for (uint32_t i = 0; i < 3000; ++i)
        {
            const gpu::vec3 from = random.inBox({-3, 0.1f, -3}, {3, 3, 3});
            const gpu::BvhTriangle& aim =
                triangles[package_->firstMovingSlot() +
                          random.below(uint32_t(triangles.size()) - package_->firstMovingSlot())];
            const gpu::vec3 to = i % 2 == 0 ? random.onTriangle(aim) : random.inBox({-3, 0, -3}, {3, 3, 3});
            rays.push_back({from, kFar, directionTo(to, from), i});
        }
        const RayStage stage(device(), *scene_);
        RayQueue queue(device(), "test.queue", 1);
        queue.rays = device().uploadTexels("test.rays", std::span<const gpu::Ray>(rays));
        const Buffer hits = device().array<gpu::Hit>("test.hits", rays.size());
        Recorder rec(device());
        rec.begin(scene_->descriptorSet());
        stage.resize(rec, queue.size, uint32_t(rays.size()));
        stage.closest(rec, queue, hits, 1);
        rec.submitAndWait();
        const auto found = device().download<gpu::Hit>(hits, rays.size());
        uint32_t compared = 0, moving = 0;
        for (size_t i = 0; i < rays.size(); ++i)
        {
            double least = 1e300, error = 0;
            bool certain = true, any = false;
            for (const Meeting& m : meetings(rays[i], triangles))
            {
                const gpu::BvhTriangle& t = triangles[m.slot];
                if (equal(t.v0, t.v1) || equal(t.v1, t.v2) || equal(t.v2, t.v0)) // hidden, or at a pole of the ball
                    continue;
                any = true;
                certain &= m.certain;
                if (m.t < least)
                {
                    least = m.t;
                    error = m.t_error;
                }
            }
            if (!certain)
                continue;
            ++compared;
            ASSERT_EQ(found[i].slot != gpu::kNone, any) << seconds << " ray " << i;
            if (!any)
                continue;
            ASSERT_NEAR(found[i].t, least, 2 * error) << seconds << " ray " << i;
            moving += found[i].slot >= package_->firstMovingSlot();
        }
        EXPECT_GT(compared, 2500u);
        EXPECT_GT(moving, 500u);
    }
}

TEST_F(Poses, TakeLightsAndCausticTargetsAlong)
{
    for (const double seconds : {0.0, 1.25})
    {
        const package::Pose pose = show(seconds);
        const auto triangles = slots();
        const auto lights = sceneBuffer<gpu::Light>(gpu::kLightsBinding, package_->lights().size());
        std::vector<std::pair<double, double>> emitters; // power but for a factor, pmf
        for (const gpu::BvhTriangle& t : triangles)
        {
            const uint32_t light = package_->triangles()[t.triangle].light;
            if (light == gpu::kNone)
                continue;
            EXPECT_TRUE(equal(lights[light].p0, t.v0) && equal(lights[light].p1, t.v1) &&
                        equal(lights[light].p2, t.v2));
            const Vec3d a = toDouble(t.v1) - toDouble(t.v0), b = toDouble(t.v2) - toDouble(t.v0);
            emitters.emplace_back(length(cross(a, b)) * double(luminance(lights[light].emission)),
                                  double(lights[light].pmf));
        }
        const auto [power, picked] = std::ranges::max(emitters);
        for (const auto& [own, pmf] : emitters)
            EXPECT_NEAR(pmf * power, picked * own, 1e-5 * picked * power) << seconds;
        EXPECT_EQ(emitters.size(), 4u); // two quads: one moves, one is dark at rest
        EXPECT_GT(picked, 0);
        ASSERT_EQ(pose.lights.size(), 2u);
        EXPECT_TRUE(equal(lights[pose.lights[0].index].p1, pose.lights[0].light.p1));

        ASSERT_EQ(package_->causticTargets().size(), 1u);
        const auto target = sceneBuffer<gpu::CausticTarget>(gpu::kCausticTargetsBinding, 1)[0];
        const auto& objects = *package_->motion()->objects();
        for (uint32_t i = 0; i < objects.size(); ++i)
        {
            if (objects[i]->caustic_target() < 0)
                continue;
            const package::MovingRange& range = package_->movingRanges()[i];
            double farthest = 0;
            for (uint32_t slot = range.first_slot; slot < range.first_slot + range.triangle_count; ++slot)
                for (const gpu::vec3 corner : corners(triangles[slot]))
                    farthest = std::max(farthest, length(toDouble(corner) - toDouble(target.center)));
            EXPECT_LE(farthest, target.radius * (1 + 1e-6));
            EXPECT_GE(farthest, 0.5 * target.radius); // of the box around it: at most sqrt(3) as far
        }
    }
}

TEST_F(Poses, TurnNormalsWithSurfaces)
{
    show(0.7);
    const auto vertices =
        sceneBuffer<gpu::VertexAttributes>(gpu::kVertexAttributesBinding, package_->vertexAttributes().size());
    // Flat facets: of every rigid triangle the normals are its own, whatever the scale.
    for (const gpu::BvhTriangle& t : slots())
    {
        const gpu::uvec3 v = package_->triangles()[t.triangle].vertices;
        const Vec3d a = toDouble(t.v0), facing = cross(toDouble(t.v1) - a, toDouble(t.v2) - a);
        const bool bent = isBent(v.x) || isBent(v.y) || isBent(v.z);
        if (length(facing) < 1e-9) // at a pole of the ball
            continue;
        for (const uint32_t vertex : {v.x, v.y, v.z})
        {
            const uint32_t bits = vertices[vertex].normal;
            double x = int16_t(bits & 0xffffu) / 32767.0, y = int16_t(bits >> 16) / 32767.0,
                   z = 1 - std::abs(x) - std::abs(y);
            const double fold = std::max(-z, 0.0);
            x += x >= 0 ? -fold : fold;
            y += y >= 0 ? -fold : fold;
            const Vec3d normal = Vec3d{x, y, z} * (1 / length(Vec3d{x, y, z}));
            // Packing takes 3e-5. The ball is smooth: its facets are 22.5 degrees apart.
            const double least = bent ? 0 : std::cos(t.material == 2 ? 0.4 : 4e-5);
            EXPECT_GT(dot(normal, facing) / length(facing), least) << vertex;
        }
    }
}
} // namespace
