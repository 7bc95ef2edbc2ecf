// How large the things in view are, against the mean of the shading points' distances; and that it takes no notice of the scene's
// size.
#include "runtime/stages/view_scale.h"
#include "tests/stages/gi_test.h"
#include "tests/stages/shading_points.h"

namespace
{
constexpr uint32_t kWidth = 40, kHeight = 30;

class ViewScales : public GiTest
{
protected:
    static Camera camera(float orthographic_height = 0)
    {
        const gpu::vec3 forward = normalize({0.2f, -0.4f, -1});
        return {.name = "",
                .position = {0.3f, 1.5f, 2},
                .forward = forward,
                .up = normalize(cross(cross(forward, {0, 1, 0}), forward)),
                .vertical_fov = orthographic_height > 0 ? 0 : 0.9f,
                .orthographic_height = orthographic_height};
    }

    /// Of a floor with a box, on ground `ground` metres wide where that is above 0, below the camera's view.
    gpu::ViewScale measured(const Camera& camera, float ground, std::vector<ShadingPoints::Point>* points = nullptr)
    {
        SceneBuilder builder;
        builder.floor(3, 0, builder.material(lambert(0.7)));
        builder.box({-0.5f, 0, -0.5f}, {0.5f, 0.6f, 0.2f}, builder.material(lambert(0.5)));
        if (ground > 0)
            builder.quad({-ground / 2, -1000, ground / 2}, {ground, 0, 0}, {0, 0, -ground},
                         builder.material(lambert(0.2)));
        const auto path = builder.compile();
        const auto scene = load(path);
        const ShadingPoints shown(device(), *scene, path, camera, kWidth, kHeight);
        ViewScaleStage stage(device(), *scene);
        submit(*scene, [&](Recorder& rec)
               { stage.record(rec, shown.gpu->points, kWidth * kHeight, cameraParams(camera, kWidth, kHeight)); });
        const gpu::ViewScale scale = contents<gpu::ViewScale>(scene->viewScale(), 1)[0];
        if (points)
            *points = shown.points;
        return scale;
    }
};

TEST_F(ViewScales, AreTheGeometricMeanDistanceOfWhatIsSeen)
{
    std::vector<ShadingPoints::Point> points;
    const gpu::ViewScale scale = measured(camera(), 0, &points);
    double logarithms = 0, count = 0;
    for (const ShadingPoints::Point& p : points)
        if (p.exists)
            logarithms += std::log(length(p.position - Double3(camera().position))), ++count;
    ASSERT_GT(count, 100);
    ASSERT_LT(count, kWidth * kHeight); // some see nothing
    EXPECT_EQ(length2(Double3(scale.focus) - Double3(camera().position)), 0);
    EXPECT_NEAR(scale.distance, std::exp(logarithms / count),
                1e-5 * scale.distance); // rounding of a thousand logarithms
}

TEST_F(ViewScales, TakeNoNoticeOfWhatIsNotInView)
{
    const Camera down{.name = "",
                      .position = {0, 1, 0.8f},
                      .forward = {0, -1, 0},
                      .up = {0, 0, -1},
                      .vertical_fov = 0.9f,
                      .orthographic_height = 0};
    EXPECT_EQ(measured(down, 20000).distance, measured(down, 0).distance);
}

TEST_F(ViewScales, AreReadBackFromTheFrameThatHasEndedWhileTheLastOneMayBeInFlight)
{
    SceneBuilder builder;
    builder.floor(3, 0, builder.material(lambert(0.7)));
    const auto path = builder.compile();
    const auto scene = load(path);
    const ShadingPoints shown(device(), *scene, path, camera(), kWidth, kHeight);
    ViewScaleStage stage(device(), *scene);
    std::vector<float> distances;
    for (uint32_t frame = 0; frame < 6; ++frame)
    {
        submit(*scene,
               [&](Recorder& rec) {
                   stage.record(rec, shown.gpu->points, kWidth * kHeight,
                                cameraParams(camera(float(frame + 1)), kWidth, kHeight));
               });
        EXPECT_EQ(stage.lastDistance(), frame < kFramesInFlight ? 0 : distances[frame - kFramesInFlight]);
        distances.push_back(contents<gpu::ViewScale>(scene->viewScale(), 1)[0].distance);
    }
    EXPECT_NE(distances[0], distances[1]);
}

/// `by` metres back along its view.
Camera movedBack(Camera camera, float by)
{
    camera.position = camera.position + -by * camera.forward;
    return camera;
}

TEST_F(ViewScales, OfParallelRaysAreThePicturesSizeFromWhereverTheyStart)
{
    const Camera near = camera(3);
    std::vector<ShadingPoints::Point> points;
    const gpu::ViewScale scale = measured(near, 0, &points);
    const double size = 1.5 * (1 + double(kWidth) / kHeight);
    EXPECT_NEAR(scale.distance, size, 1e-5);
    const gpu::ViewScale far = measured(movedBack(near, 64), 0);
    EXPECT_EQ(far.distance, scale.distance);
    // Rays from there meet the scene beside the others by rounding: one of a thousand may pass an edge and meet something else.
    EXPECT_LT(length(Double3(far.focus) - Double3(scale.focus)), 1e-3 * size);
    double depths = 0, count = 0;
    for (const ShadingPoints::Point& p : points)
        if (p.exists)
            depths += dot(p.position - Double3(near.position), Double3(near.forward)), ++count;
    ASSERT_GT(count, 100);
    EXPECT_NEAR(dot(Double3(scale.focus) - Double3(near.position), Double3(near.forward)), depths / count - size,
                1e-5 * size);
}

TEST_F(ViewScales, OfANarrowAngleAreThoseOfAUsualOneThatShowsAsMuch)
{
    Camera narrow = movedBack(camera(), 50);
    narrow.vertical_fov = 0.04f;
    std::vector<ShadingPoints::Point> points;
    const gpu::ViewScale scale = measured(narrow, 0, &points);
    double logarithms = 0, count = 0;
    for (const ShadingPoints::Point& p : points)
        if (p.exists)
            logarithms += std::log(length(p.position - Double3(narrow.position))), ++count;
    ASSERT_GT(count, 100);
    const double mean = std::exp(logarithms / count);
    // Of a usual camera, half the picture's width and height are two thirds of its distance.
    const double distance = mean * std::tan(0.02) * (1 + double(kWidth) / kHeight) * 1.5;
    EXPECT_NEAR(scale.distance, distance, 1e-5 * mean);
    const Double3 focus = Double3(narrow.position) + (mean - distance) * Double3(narrow.forward);
    EXPECT_LT(length(Double3(scale.focus) - focus), 1e-5 * mean);
}
} // namespace
