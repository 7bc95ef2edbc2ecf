#include "tools/bench/motion.h"

#include "image/write_image.h"
#include "runtime/gpu/cache_folder.h"
#include "shaders/lib/terms.h"
#include "tools/bench/motion_report.h"
#include "tools/bench/played_animation.h"
#include "tools/bench/reference_cache.h"
#include "tools/compare/picture.h"

#include <algorithm>
#include <cmath>

namespace
{
/// As lumicut-compare shows linear radiance to LDR-FLIP: exposed and clamped; sRGB's curve cancels.
ImageF displayed(ImageF image, float exposure)
{
    const float scale = std::exp2(exposure);
    for (float& value : image.rgb)
        value = std::clamp(scale * value, 0.0f, 1.0f);
    return image;
}

/// Path-traced pictures of one package, kept from run to run.
class References
{
public:
    References(const OpenedPackage& opened, const MotionBenchOptions& options)
        : opened_(opened), options_(options), cache_(folderOf(options)), package_(packageHash(opened.package)),
          renderer_(*opened.device, *opened.scene, Mode::kReference, options.width, options.height),
          rec_(*opened.device)
    {
    }

    Result<ImageF> picture(const Camera& camera, uint32_t term, uint32_t sample_count, uint64_t lights)
    {
        const ReferenceKey key{.package = package_,
                               .camera = camera,
                               .width = options_.width,
                               .height = options_.height,
                               .sample_count = sample_count,
                               .depth_limit = options_.settings.reference_depth,
                               .term = term,
                               .lights = lights};
        return cache_.picture(key, [&] { return render(key); });
    }

private:
    static std::filesystem::path folderOf(const MotionBenchOptions& options)
    {
        return !options.cache.empty()
                   ? options.cache
                   : cacheFolder().value_or(std::filesystem::temp_directory_path() / "lumicut") / "references";
    }

    ImageF render(const ReferenceKey& key)
    {
        Settings settings;
        settings.reference_depth = key.depth_limit;
        settings.term = key.term;
        renderer_.restart();
        for (uint32_t done = 0; done < key.sample_count;)
        {
            const uint32_t count = std::min(renderer_.maxBatch(), key.sample_count - done);
            rec_.begin(opened_.scene->descriptorSet());
            renderer_.record(rec_, key.camera, settings, uint32_t(key.hash()), count);
            rec_.submitAndWait();
            done += count;
        }
        return pictureOf(renderer_, *opened_.device);
    }

    const OpenedPackage& opened_;
    const MotionBenchOptions& options_;
    ReferenceCache cache_;
    uint64_t package_;
    Renderer renderer_;
    Recorder rec_;
};

Status dumpFrame(const std::filesystem::path& folder, uint32_t number, const SequenceFrame& frame, const FlipMap& flip)
{
    const auto write = [&](const char* name, const Picture& picture)
    {
        const std::filesystem::path path = folder / fmt::format("{:04}-{}.png", number, name);
        const Status status = writePng(path, picture.width, picture.height, 3, picture.rgb);
        return status ? status : Status(status.error().about(path.string()));
    };
    if (const Status status = write("frame", exposedPicture(frame.picture, 1)); !status)
        return status;
    if (const Status status = write("reference", exposedPicture(frame.reference, 1)); !status)
        return status;
    return write("flip", flipPicture(flip, frame.picture.width, frame.picture.height));
}

Status measureSequence(const OpenedPackage& opened, const MotionBenchOptions& options, const CameraOfFrame& camera,
                       const Geometry& geometry, ChangingLights& lights, PlayedAnimation& animation,
                       MotionResult& result)
{
    Renderer renderer(*opened.device, *opened.scene, modeOf(options), options.width, options.height, options.settings);
    References references(opened, options);
    Recorder rec(*opened.device);
    rec.timeScopes(true);
    const uint32_t term = options.settings.term;
    const bool has_caustics =
        opened.scene->info().caustic_target_count > 0 && (term == gpu::kTermAll || term == gpu::kTermCaustics);
    for (int32_t number = -int32_t(options.warm_up); number < int32_t(options.frames); ++number)
    {
        rec.begin(opened.scene->descriptorSet());
        lights.set(rec, number);
        {
            const auto scope = rec.scope("frame");
            animation.show(rec, number);
            renderer.record(rec, camera(number), options.settings, frameSeed(options, number));
        }
        const std::vector<StageTime> times = rec.submitAndWait();
        if (number < 0)
            continue;
        result.stages.add(times);
        if (const std::optional<double> share = renderer.rememberedShare(*opened.device))
            result.reprojected = result.reprojected.value_or(0) + *share / options.frames;
        const auto reference =
            references.picture(camera(number), term, options.sample_count, lights.hash() ^ animation.hash());
        if (!reference)
            return reference.error();
        const ImageF picture = pictureOf(renderer, *opened.device);
        result.light.add(picture, *reference);
        SequenceFrame frame{.picture = displayed(picture, options.settings.exposure),
                            .reference = displayed(*reference, options.settings.exposure),
                            .hits = geometry.firstHits(camera(number), options.width, options.height),
                            .plain = {}};
        frame.plain = geometry.plainPixels(frame.hits);
        if (has_caustics)
        {
            const auto caustics =
                references.picture(camera(number), gpu::kTermCaustics, std::max(options.sample_count / 8, 1u),
                                   lights.hash() ^ animation.hash());
            if (!caustics)
                return caustics.error();
            excludeCaustics(frame.plain, *reference, *caustics);
        }
        result.plain.add(double(std::ranges::count(frame.plain, uint8_t(1))) / double(frame.plain.size()));
        const SequenceFrame kept = options.dump.empty() ? SequenceFrame{} : frame;
        const FlipMap flip = result.metrics.add(std::move(frame));
        if (!options.dump.empty())
            if (const Status status = dumpFrame(options.dump, uint32_t(number), kept, flip); !status)
                return status;
    }
    rec.begin(opened.scene->descriptorSet());
    lights.restore(rec);
    rec.submitAndWait();
    return Success{};
}
} // namespace

uint32_t frameSeed(const MotionBenchOptions& options, int32_t frame)
{
    if (modeOf(options) != Mode::kDirect && goesOn(options.settings))
        return options.seed; // the renderer takes other numbers in every frame
    // A bijection, so that no two frames are the same, whose numbers are far apart: stages add small ones of their own.
    uint32_t x = options.seed * 0x9e3779b9u + uint32_t(frame);
    x = (x ^ (x >> 16)) * 0x85ebca6bu; // the finalizer of MurmurHash3
    x = (x ^ (x >> 13)) * 0xc2b2ae35u;
    return x ^ (x >> 16);
}

Mode modeOf(const MotionBenchOptions& options)
{
    return options.mode == "gi" ? Mode::kGi : options.mode == "direct" ? Mode::kDirect : Mode::kFilteredPaths;
}

Status benchMotion(const MotionBenchOptions& options)
{
    const auto opened = openPackage(options);
    if (!opened)
        return opened.error();
    if (const Status status =
            Renderer::checkSize(*opened->device, options.width, options.height, modeOf(options), options.settings);
        !status)
        return status;
    if (std::error_code failed;
        !options.dump.empty() && (std::filesystem::create_directories(options.dump, failed), failed))
        return Error{ExitCode::kIo, fmt::format("the folder cannot be made: {}", failed.message()),
                     options.dump.string()};
    const Geometry geometry(*opened, std::max(options.width * options.height, 1024u));
    const auto camera = chooseMotion(options.path, options.frames_per_second, *opened, geometry);
    if (!camera)
        return camera.error();
    const auto change = std::ranges::find(kLightChangeNames, std::string_view(options.lights));
    auto lights =
        ChangingLights::create(*opened, LightChange(change - kLightChangeNames.begin()), int32_t(options.frames / 2));
    if (!lights)
        return lights.error();
    auto animation = PlayedAnimation::create(*opened, options.animation, options.frames_per_second);
    if (!animation)
        return animation.error();
    MotionResult result;
    if (const Status status = measureSequence(*opened, options, *camera, geometry, *lights, *animation, result);
        !status)
        return status;
    if (options.ghost)
        result.ghost = measureGhost(*opened, options, *camera);
    (options.json ? printJson : print)(options, *opened, result);
    return Success{};
}
