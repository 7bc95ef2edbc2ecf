// Sequences of lumicut-play: the same bytes however a sequence is split or interrupted, and what is said of bad requests.
#include "image/read_exr.h"
#include "runtime/frame_writer.h"
#include "runtime/headless.h"
#include "runtime/sequence.h"
#include "tests/stages/sequence_folder.h"

#include <numeric>

namespace
{
/// The player's parts in this process, so that pipelines are built once: a sequence of mode gi, which remembers.
class RememberingSequence : public SequenceFolder
{
protected:
    void SetUp() override
    {
        SequenceFolder::SetUp();
        options_ = {.package = folder_ / "cornell.lumi",
                    .headless = true,
                    .width = 24,
                    .height = 16,
                    .path = folder_ / "path.json",
                    .fps = 12,
                    .part = 4,
                    .preset = "preview",
                    .assignments = {"photons.count=500", "samples.count=64"}};
        auto opened = openScene(options_, {}, statistics_);
        ASSERT_TRUE(opened) << opened.error().message;
        opened_.emplace(std::move(*opened));
    }

    /// Frames first to last in short parts, so that there are several.
    void render(const std::string& folder, uint32_t first, uint32_t last, int64_t warm_up = 2)
    {
        std::filesystem::create_directory(folder_ / folder);
        const auto names = FrameFiles::parse(folder_ / folder / "f%02d.exr");
        ASSERT_TRUE(names) << names.error().message;
        std::vector<uint32_t> frames(last - first + 1);
        std::iota(frames.begin(), frames.end(), first);
        const Status status = renderFrames(options_, *opened_, *names, frames, statistics_, warm_up);
        EXPECT_TRUE(status) << status.error().message;
    }

    PlayerOptions options_;
    Statistics statistics_;
    std::optional<OpenedScene> opened_;
};

TEST_F(RememberingSequence, HasTheSameBytesInPieces)
{
    render("whole", 0, 11);
    ASSERT_EQ(files("whole").size(), 12u);
    EXPECT_NE(frame("whole", "f00.exr"), frame("whole", "f11.exr"));
    for (const uint32_t first : {9u, 0u, 6u, 3u})
        render("pieces", first, first + 2);
    expectWhole("pieces");
    render("cold", 4, 4, 0);
    EXPECT_NE(frame("cold", "f04.exr"), frame("whole", "f04.exr")); // or there would be nothing to remember

    // Parts of another length have other frames, and are not mixed with these.
    options_.part = 8;
    options_.sequence = {0, 8};
    render("long", 0, 8);
    for (const uint32_t first : {6u, 0u, 3u})
        render("long pieces", first, first + 2);
    for (const std::string& name : files("long"))
        EXPECT_EQ(frame("long pieces", name), frame("long", name)) << name;
    options_.output = folder_ / "long/f%02d.exr";
    options_.part = 4;
    const Status mixed = playSequence(options_);
    ASSERT_FALSE(mixed);
    EXPECT_EQ(mixed.error().code, ExitCode::kInvalid);
    EXPECT_TRUE(contains(mixed.error().message, "(part 8, not 4)")) << mixed.error().message;
    options_.sequence.reset();
    options_.output.clear();

    // Frames of many samples are standing pictures, each by itself. (Frame 0 of seed 0 has seed 0.)
    options_.sample_count = 2;
    render("still", 0, 1);
    render("second", 1, 1);
    EXPECT_EQ(frame("still", "f01.exr"), frame("second", "f01.exr"));
    std::optional<Renderer> renderer;
    ASSERT_TRUE(makeRenderer(renderer, *opened_, Mode::kGi, options_.width, options_.height, opened_->settings));
    Recorder rec(*opened_->device);
    EXPECT_TRUE(renderSamples(rec, *renderer, *opened_, Moment{}, 0, 2, statistics_));
    const auto origin = originOf(*opened_, options_);
    ASSERT_TRUE(origin) << origin.error().message;
    ASSERT_TRUE(Capture(folder_ / "still/picture.exr", *renderer, *opened_->device, *opened_->scene, opened_->settings)
                    .write(originNotes(*origin)));
    EXPECT_EQ(frame("still", "f00.exr"), frame("still", "picture.exr"));
}

TEST_F(RememberingSequence, NamesTheFrameThatCannotBeWritten)
{
    std::optional<Renderer> renderer;
    ASSERT_TRUE(makeRenderer(renderer, *opened_, Mode::kDirect, options_.width, options_.height, opened_->settings));
    Recorder rec(*opened_->device);
    EXPECT_TRUE(renderSamples(rec, *renderer, *opened_, Moment{}, 0, 1, statistics_));
    FrameWriter writer({}, 2);
    for (const char* name : {"a.exr", "missing/b.png"}) // the second waits for the first at most
        EXPECT_TRUE(
            writer.write(Capture(folder_ / name, *renderer, *opened_->device, *opened_->scene, opened_->settings)))
            << name;
    const Status status = writer.finish();
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().file, (folder_ / "missing/b.png").string());
    EXPECT_EQ(status.error().code, ExitCode::kIo);
    EXPECT_EQ(writer.writtenCount(), 1u);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "a.exr"));
}

/// The player's scene keeps its pose from part to part: none of it may be seen in the next one.
TEST_F(RememberingSequence, OfAnAnimationHasTheSameBytesInPieces)
{
    ASSERT_EQ(runProgram(LUMICUT_SCENES, quoted("") + " lamp").exit_code, 0);
    ASSERT_EQ(runProgram(LUMICUT_COMPILE, "-q " + quoted("lamp.glb")).exit_code, 0);
    options_.package = folder_ / "lamp.lumi";
    options_.path.clear();
    options_.animation = "all";
    options_.fps = 2; // it is carried far from part to part
    const auto openAnew = [&]
    {
        auto opened = openScene(options_, {}, statistics_);
        ASSERT_TRUE(opened) << opened.error().message;
        opened_.emplace(std::move(*opened));
    };
    openAnew();
    render("whole", 0, 7);
    EXPECT_NE(frame("whole", "f00.exr"), frame("whole", "f07.exr"));
    for (const uint32_t first : {6u, 0u, 2u, 4u})
        render("pieces", first, first + 1);
    expectWhole("pieces");
    openAnew(); // by a program that has shown nothing before
    render("alone", 4, 5);
    for (const char* name : {"f04.exr", "f05.exr"})
        EXPECT_EQ(frame("alone", name), frame("whole", name));
}

/// Pixels of the back wall of the box, a white Lambertian 2.45 m before the camera: by their normals.
void expectBackWall(std::span<const gpu::LayerSums> layers, uint32_t frame_count, uint32_t width, uint32_t height)
{
    const double half_height = 0.5 / 1.47, pixel = 2 * half_height / height; // at distance 1
    size_t count = 0;
    for (uint32_t i = 0; i < layers.size(); ++i)
    {
        const gpu::vec3 normal = 1 / float(frame_count) * layers[i].normal;
        if (std::abs(normal.z - 1) > 1e-5)
            continue;
        ++count;
        const double x = (i % width + 0.5 - width * 0.5) * pixel, y = (i / width + 0.5 - height * 0.5) * pixel;
        // The sample lies anywhere in the pixel.
        EXPECT_NEAR(layers[i].depth, 2.45 * std::sqrt(1 + x * x + y * y), 2.45 * pixel * std::sqrt(0.5)) << i;
        EXPECT_NEAR(layers[i].albedo.x / float(frame_count), 0.73, 0.73 / 255) << i;
    }
    EXPECT_GT(count, layers.size() / 20);
}

TEST_F(RememberingSequence, LayersAddUpToThePicture)
{
    Settings settings = opened_->settings;
    settings.antialias_frames = 0; // edges of the picture are smoothed, not those of its terms
    std::optional<Renderer> renderer;
    ASSERT_TRUE(makeRenderer(renderer, *opened_, Mode::kGi, options_.width, options_.height, settings, true));
    Recorder rec(*opened_->device);
    for (uint32_t frames = 1; frames <= 2; ++frames)
    {
        rec.begin(opened_->scene->descriptorSet());
        renderer->record(rec, opened_->camera(), settings, 7);
        rec.submitAndWait();
        ASSERT_EQ(renderer->sampleCount(), frames);
        const std::vector<gpu::vec3> picture = renderer->picture(*opened_->device);
        const std::vector<gpu::LayerSums> layers = renderer->layerSums(*opened_->device);
        double direct = 0, indirect = 0;
        for (size_t i = 0; i < picture.size(); ++i)
        {
            const gpu::LayerSums& l = layers[i];
            const double sum = double(l.emission.x) + l.direct.x + l.caustics.x + l.indirect.x + l.glossy.x;
            EXPECT_NEAR(sum / frames, picture[i].x, 1e-5 * picture[i].x + 1e-7) << i; // roundings of a dozen floats
            direct += l.direct.x;
            indirect += l.indirect.x;
        }
        EXPECT_GT(direct, 0);
        EXPECT_GT(indirect, 0);
        expectBackWall(layers, frames, options_.width, options_.height);
    }
    const std::vector<std::string> names(kLayerNames.begin(), kLayerNames.end());
    ASSERT_TRUE(Capture(folder_ / "layers.exr", *renderer, *opened_->device, *opened_->scene, settings, names).write());
    const std::string bytes = fileBytes(folder_ / "layers.exr");
    for (const char* channel : {"R", "Z", "albedo.R", "caustics.G", "direct.B", "emission.R", "glossy.R", "indirect.R",
                                "motion.Y", "normal.X"})
        EXPECT_TRUE(contains(bytes, std::string(1, '\0') + channel + std::string(1, '\0'))) << channel;
    const auto read = readExr(folder_ / "layers.exr");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->rgb[0], renderer->picture(*opened_->device)[0].x);
}

struct Place // in a picture, pixels from its upper left corner
{
    double x, y;
};

/// Where a pinhole camera shows a point.
Place placeOf(const Camera& camera, gpu::vec3 point, uint32_t width, uint32_t height)
{
    const gpu::vec3 d = point + -1.0f * camera.position, right = normalize(cross(camera.forward, camera.up));
    const double scale = height / (2 * std::tan(camera.vertical_fov / 2.0) * dot(d, normalize(camera.forward)));
    return {width / 2.0 + scale * dot(d, right),
            height / 2.0 - scale * dot(d, cross(right, normalize(camera.forward)))};
}

/// The point at a distance along the ray through the centre of a pixel.
gpu::vec3 pointAt(const Camera& camera, uint32_t pixel, float distance, uint32_t width, uint32_t height)
{
    const gpu::vec3 forward = normalize(camera.forward), right = normalize(cross(forward, camera.up));
    const double pixel_side = 2 * std::tan(camera.vertical_fov / 2.0) / height;
    const auto x = float((pixel % width + 0.5 - width / 2.0) * pixel_side);
    const auto y = float((height / 2.0 - pixel / width - 0.5) * pixel_side);
    return camera.position + distance * normalize(forward + x * right + y * cross(right, forward));
}

TEST_F(RememberingSequence, MotionIsToWhereTheLastCameraSawTheSame)
{
    Settings settings = opened_->settings;
    settings.antialias_frames = 0; // rays of moving pictures go through other places than the pixels' centres
    const uint32_t width = options_.width, height = options_.height;
    std::optional<Renderer> renderer;
    ASSERT_TRUE(makeRenderer(renderer, *opened_, Mode::kGi, width, height, settings, true));
    Recorder rec(*opened_->device);
    const auto layersOf = [&](const Camera& camera)
    {
        rec.begin(opened_->scene->descriptorSet());
        renderer->record(rec, camera, settings, 7);
        rec.submitAndWait();
        return renderer->layerSums(*opened_->device);
    };
    const Camera last = opened_->path->at(0.25), now = opened_->path->at(0.5);
    const auto first = layersOf(last), moved = layersOf(now), still = layersOf(now);
    const double pixel = 2 * std::tan(now.vertical_fov / 2.0) / height; // radians, the largest
    const gpu::vec3 way = now.position + -1.0f * last.position;
    size_t far = 0;
    for (uint32_t i = 0; i < moved.size(); ++i)
    {
        EXPECT_EQ(first[i].motion.x, 0);
        EXPECT_EQ(still[i].motion.y, 0);
        if (!(moved[i].depth < gpu::kSkyDepth))
            continue;
        const Place at = placeOf(last, pointAt(now, i, moved[i].depth, width, height), width, height);
        const double x = at.x - (i % width + 0.5), y = at.y - (i / width + 0.5);
        // The sample lies up to half a diagonal from the centre, so that its distance along the centre's ray is less by up to a
        // quarter of the pixel's square; that part of the camera's way counts. Floats have 24 bits.
        const double nearer = pixel * pixel / 4 * std::sqrt(dot(way, way)) / moved[i].depth / pixel;
        const double tolerance = 2 * nearer + 1e-4;
        EXPECT_NEAR(moved[i].motion.x, x, tolerance) << i;
        EXPECT_NEAR(moved[i].motion.y, y, tolerance) << i;
        far += std::hypot(x, y) > 0.5;
    }
    EXPECT_GT(far, moved.size() / 4);
}

TEST_F(SequenceProgram, GoesOnWhereItWasInterrupted)
{
    expectPlayed("whole", "--frames 0-11");
    ASSERT_EQ(files("whole").size(), 12u);

    EXPECT_EQ(playUntil("resumed", "--frames 0-11", "f001.exr", "TERM"), 128 + 15);
    for (const std::string& name : files("resumed")) // and no temporary file
        EXPECT_EQ(frame("resumed", name), frame("whole", name)) << name;
    EXPECT_EQ(playUntil("resumed", "--frames 0-11", "f005.exr", "KILL"), 128 + 9);
    for (const std::string& name : files("resumed"))
        if (name.ends_with(".tmp")) // no program can remove it
            std::filesystem::remove(folder_ / "resumed" / name);
        else
            EXPECT_EQ(frame("resumed", name), frame("whole", name)) << name;
    EXPECT_LT(files("resumed").size(), 12u);

    const auto write_time = [&](const char* name)
    { return std::filesystem::last_write_time(folder_ / "resumed" / name); };
    std::filesystem::resize_file(folder_ / "resumed/f003.exr", 300);
    const ProgramRun list = play("resumed", "--frames 2-5 --list-missing");
    EXPECT_EQ(list.exit_code, 0) << list.err;
    EXPECT_EQ(list.out, "3\n");
    const auto before = write_time("f004.exr");
    expectPlayed("resumed", "--frames 0-11");
    expectWhole("resumed");
    EXPECT_EQ(write_time("f004.exr"), before); // left alone
    expectPlayed("resumed", "--frames 4-4 --force");
    expectWhole("resumed");
    EXPECT_NE(write_time("f004.exr"), before);

    // What is there needs no device.
    const std::string all = command("whole", "--frames 0-11 --stats " + quoted("stats.json"));
    const ProgramRun run = runProgram(
        "/usr/bin/env", fmt::format("VK_ICD_FILENAMES=/none VK_DRIVER_FILES=/none '{}' {}", LUMICUT_PLAY, all));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(contains(fileBytes(folder_ / "stats.json"), "\"submissions\": 0")) << run.err;
}

TEST_F(SequenceProgram, RefusesBadRequestsInASentence)
{
    const auto refused = [&](const std::string& arguments, int code, const std::string& words)
    {
        SCOPED_TRACE(arguments);
        const ProgramRun run = runProgram(LUMICUT_PLAY, quoted("cornell.lumi") + " " + arguments);
        EXPECT_EQ(run.exit_code, code);
        EXPECT_TRUE(contains(run.err, words)) << run.err;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
        EXPECT_EQ(run.out, "");
    };
    std::filesystem::create_directory(folder_ / "refused");
    const std::string path = "--path " + quoted("path.json"), output = " --output " + quoted("refused/f%d.exr");
    const std::string sequence = "--headless " + path + output + " --size 24x16 ";
    refused(sequence + "--frames 5-3", 1, "comes before");
    for (const std::string range : {"3-", "1-2-3", "a-b", "0-99999999", "''"})
        refused(sequence + "--frames " + range, 1, "--frames: ");
    refused("--headless --frames 0-3" + output, 1, "--path FILE");
    refused("--headless --frames 0-3 " + path, 1, "--output frame-%04d.exr");
    refused(sequence, 1, "--frames A-B");
    refused(sequence + "--frames 3", 1, "--frames A-B");
    refused(path + " --frames 0-3" + output, 1, "--headless");
    refused(sequence + "--frames 0-3 --camera 0", 1, "give one");
    refused("--headless --fps 12", 1, "--fps is for sequences");
    refused("--headless --list-missing", 1, "--list-missing is for sequences");
    for (const char* fps : {"0", "nan", "x"})
        refused(sequence + "--frames 0-3 --fps " + fps, 1, "--fps");
    for (const char* time : {"-1", "nan", "inf"})
        refused(sequence + "--frames 0-3 --time " + time, 1, "--time");
    refused(sequence + "--frames 0-3 --layers depht", 1, "--layers");
    refused("--headless --layers depth --output " + quoted("refused/f.png"), 1, "FILE.exr");
    refused("--headless --layers depth --mode reference --output " + quoted("refused/f.exr"), 1, "mode gi");
    for (const std::string name :
         {"f.exr", "f%s.exr", "f%5d.exr", "f%d%d.exr", "f%%d.exr", "f%.exr", "f%0d.exr", "%d/f.exr", "%d/f%d.exr"})
        refused("--headless --frames 0-3 " + path + " --output " + quoted("refused/" + name), 1, "%d or %0Nd");
    refused("--headless --frames 0-3 " + path + " --output " + quoted("refused/f%d.jpg"), 1, ".exr or .png");
    refused("--headless --frames 0-3 " + path + " --output " + quoted("none/f%d.exr"), 2, "none");
    refused("--headless --frames 0-3" + output + " --path " + quoted("none.json"), 2, "none.json: error: ");
    refused("--headless --frames 0-3" + output + " --path " + quoted("cornell.lumi"), 3, "JSON");
    std::ofstream(folder_ / "empty.json") << R"({"schema": "lumicut-path/1", "keys": []})";
    refused("--headless --frames 0-3" + output + " --path " + quoted("empty.json"), 3, "(/keys)");
    EXPECT_EQ(files("refused"), std::set<std::string>());
    std::ofstream(folder_ / "refused/f2.exr") << "notes";
    refused(sequence + "--frames 0-3", 2, "f2.exr: error: is there already");
    refused(sequence + "--frames 0-3 --list-missing", 2, "--force");
    EXPECT_EQ(files("refused"), std::set<std::string>{"f2.exr"});
}
} // namespace
