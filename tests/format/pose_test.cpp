// Poses against closed forms.
#include "format/pose.h"
#include "tests/format/sample_package.h"

#include <gtest/gtest.h>

namespace
{
struct Posed
{
    std::vector<std::byte> bytes;
    package::Package package;

    explicit Posed(const SamplePackage& sample) : bytes(sample.bytes()), package(open(bytes)) {}

    static package::Package open(std::span<const std::byte> bytes)
    {
        auto package = package::Package::openBytes(bytes);
        EXPECT_TRUE(package) << package.error().message;
        return std::move(*package);
    }
};

void expectRow(const gpu::vec4& row, double x, double y, double z, double w, const char* what)
{
    EXPECT_NEAR(row.x, x, 1e-6) << what;
    EXPECT_NEAR(row.y, y, 1e-6) << what;
    EXPECT_NEAR(row.z, z, 1e-6) << what;
    EXPECT_NEAR(row.w, w, 1e-6) << what;
}

TEST(Pose, AtRestHasTheFilesNodes)
{
    const Posed posed(SamplePackage::moving());
    const package::Pose pose = package::poseAtRest(posed.package);
    ASSERT_EQ(pose.bones.size(), 2u);
    for (const gpu::BoneMatrix& bone : pose.bones)
    {
        expectRow(bone.x, 1, 0, 0, 0, "x");
        expectRow(bone.y, 0, 1, 0, 0, "y");
        expectRow(bone.z, 0, 0, 1, 0, "z");
    }
    EXPECT_EQ(pose.weights, std::vector<float>{0});
    ASSERT_EQ(pose.lights.size(), 1u);
    EXPECT_EQ(pose.lights[0].light.emission.x, 1);
    EXPECT_EQ(pose.lights[0].light.pmf, 0.25f);
    ASSERT_EQ(pose.cameras.size(), 1u);
    EXPECT_EQ(pose.cameras[0].vertical_fov, 0.8f);
    EXPECT_TRUE(pose.materials.empty());
}

TEST(Pose, ParentsMoveChildrenAndChannelsSetTheRest)
{
    const Posed posed(SamplePackage::moving());
    const package::Pose pose = package::poseAt(posed.package, 0, 0.5);
    const double t = 0.25, t2 = t * t, t3 = t2 * t;
    const double along = 2 * (t3 - 2 * t2 + t) + (3 * t2 - 2 * t3) + 2 * (t3 - t2);
    expectRow(pose.bones[0].x, 1, 0, 0, along, "arm x");
    expectRow(pose.bones[1].x, 0, -1, 0, along, "hand x"); // half of half a turn about z
    expectRow(pose.bones[1].y, 1, 0, 0, 0, "hand y");
    EXPECT_FLOAT_EQ(pose.weights[0], 0.5f);
    EXPECT_FLOAT_EQ(pose.lights[0].light.emission.y, 0.5f);
    EXPECT_NEAR(pose.lights[0].light.p0.x, along, 1e-6);
    EXPECT_FLOAT_EQ(pose.cameras[0].vertical_fov, 0.6f);
    EXPECT_NEAR(pose.cameras[0].position.x, along, 1e-6);
    ASSERT_EQ(pose.materials.size(), 1u);
    EXPECT_EQ(pose.materials[0].index, 1u);
    EXPECT_FLOAT_EQ(pose.materials[0].material.emission.x, 4);
}

TEST(Pose, HiddenNodesHaveNoExtentAndNoLight)
{
    const Posed posed(SamplePackage::moving());
    const package::Pose pose = package::poseAt(posed.package, std::nullopt, 1);
    for (const gpu::BoneMatrix& bone : pose.bones)
    {
        expectRow(bone.x, 0, 0, 0, 0, "x");
        expectRow(bone.y, 0, 0, 0, 0, "y");
        expectRow(bone.z, 0, 0, 0, 0, "z");
    }
    EXPECT_EQ(pose.lights[0].light.emission.x, 0);
}

TEST(Pose, LengthsAreThePackages)
{
    SamplePackage sample = SamplePackage::moving();
    sample.meta.origin = std::make_unique<lumicut::fb::Vec3d>(100.0, 0.0, -8.0);
    sample.meta.unit = 4;
    sample.motion->nodes[0]->translation = std::make_unique<lumicut::fb::Double3>(102.0, 1.0, -8.0);
    const Posed posed(sample);
    const package::Pose pose = package::poseAtRest(posed.package);
    expectRow(pose.bones[0].x, 0.25, 0, 0, 0.5, "x"); // metres of the mesh become units
    expectRow(pose.bones[0].y, 0, 0.25, 0, 0.25, "y");
    expectRow(pose.bones[0].z, 0, 0, 0.25, 0, "z");
    EXPECT_FLOAT_EQ(pose.lights[0].light.emission.x, 1.0f / 16);
    EXPECT_FLOAT_EQ(pose.lights[0].light.p0.x, 0.5f);
}
} // namespace
