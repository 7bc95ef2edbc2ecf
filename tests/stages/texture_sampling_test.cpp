// What shaders read of textures of all sizes, in pages of their own and in tiles, against a slow twin that knows nothing of
// pages: it filters the image itself.
#include "compiler/compile.h"
#include "compiler/mip_chain.h"
#include "tests/compiler/gltf_builder.h"
#include "tests/stages/sampling_test.h"

#include <fmt/format.h>
#include <random>

namespace
{
/// What lookups along an ellipse are: the mean of `count` of them.
struct Lookups
{
    double along_u, along_v; // its longest diameter
    double count, level;
    bool is_sure; // rounding cannot make one more of them, or one less
};

constexpr double kMostLookups = 8;

/// The ellipse of all axis_a cos t + axis_b sin t, by the t of its longest diameter. @param width, height texels
Lookups lookupsAlong(const gpu::TexturePlace& place, double width, double height)
{
    const double ax = place.axis_a.x * width, ay = place.axis_a.y * height;
    const double bx = place.axis_b.x * width, by = place.axis_b.y * height;
    const double t = 0.5 * std::atan2(2 * (ax * bx + ay * by), ax * ax + ay * ay - bx * bx - by * by);
    const double x = ax * std::cos(t) + bx * std::sin(t), y = ay * std::cos(t) + by * std::sin(t);
    const double across = std::hypot(bx * std::cos(t) - ax * std::sin(t), by * std::cos(t) - ay * std::sin(t));
    const double length = std::hypot(x, y), shorter = std::max(across, 1.0), longer = std::max(length, 1.0);
    const double ratio = longer / shorter + 0.5, count = std::clamp(std::floor(ratio), 1.0, kMostLookups);
    const double scale = length > 0 ? longer / length : 0;
    return {.along_u = scale * x / width,
            .along_v = scale * y / height,
            .count = count,
            .level = std::log2(std::sqrt(shorter * std::max(longer / count, 1.0))),
            .is_sure = std::abs(ratio - std::round(ratio)) > 1e-4 * ratio};
}

enum class Wrap
{
    kRepeat = 10497,
    kClamp = 33071,
    kMirror = 33648
};

/// A scene of one triangle a texture: metallic-roughness maps, which are read as they are stored.
class TextureSampling : public Sampling
{
protected:
    /// @param smooth: so that blocks hold it well @return its index, of images and TextureRefs alike
    uint32_t addTexture(uint32_t width, uint32_t height, Wrap u, Wrap v)
    {
        TextureImage image{"", width, height, false, std::vector<uint8_t>(size_t(4) * width * height, 255)};
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x)
            {
                const double s = 2 * kPi * (x + 0.5) / width, t = 2 * kPi * (y + 0.5) / height;
                uint8_t* texel = image.texels.data() + 4 * (size_t(y) * width + x);
                texel[0] = 0;
                texel[1] = uint8_t(std::lround(128 + 100 * std::sin(s + images_.size())));
                texel[2] = uint8_t(std::lround(128 + 100 * std::sin(t)));
            }
        const int texture = gltf_.texture(width, height, image.texels);
        gltf_.json["samplers"].push_back({{"wrapS", int(u)}, {"wrapT", int(v)}});
        gltf_.json["textures"][size_t(texture)]["sampler"] = texture;
        gltf_.material({{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", texture}}}}}});
        images_.push_back(std::move(image));
        wraps_.push_back({u, v});
        return uint32_t(texture);
    }

    std::unique_ptr<SceneGpu> compiled(TextureCompression compression)
    {
        const std::vector<float> triangle{0, 0, 0, 1, 0, 0, 0, 1, 0};
        const nlohmann::json positions = gltf_.positions(triangle);
        const nlohmann::json uv = gltf_.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2", 5126, 3);
        nlohmann::json primitives = nlohmann::json::array();
        for (size_t i = 0; i < images_.size(); ++i)
            primitives.push_back({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uv}}}, {"material", i}});
        gltf_.json["meshes"] = {{{"primitives", primitives}}};
        gltf_.json["nodes"] = {{{"mesh", 0}}};
        gltf_.writeGltf(folder_ / "scene.gltf");
        CompileOptions options{.input = folder_ / "scene.gltf", .output = folder_ / "scene.lumi"};
        options.textures = compression;
        const auto report = ::compile(options);
        check(bool(report), "{}", report ? "" : report.error().message);
        tiled_ = std::ranges::count_if(report->meta.texture_pages, [](const auto& page) { return page->tiled; });
        return load(options.output);
    }

    /// @param coarse texels of the coarser of two blended levels: it is never filtered beyond its edge
    static float wrapped(float x, Wrap wrap, uint32_t coarse)
    {
        if (wrap == Wrap::kMirror)
            x = 1 - std::abs(1 - (x - 2 * std::floor(x / 2)));
        return wrap == Wrap::kRepeat ? x : std::clamp(x, 0.5f / float(coarse), 1 - 0.5f / float(coarse));
    }

    /// Bilinear, of one level, channels 1 and 2, 0 to 1.
    static std::array<float, 2> filtered(const MipChain& chain, uint32_t level, std::array<Wrap, 2> wrap,
                                         uint32_t coarse, float u, float v)
    {
        const int width = int(chain.width(level)), height = int(chain.height(level));
        const float x = wrapped(u, wrap[0], chain.width(coarse)) * float(width) - 0.5f;
        const float y = wrapped(v, wrap[1], chain.height(coarse)) * float(height) - 0.5f;
        const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
        const auto place = [](int i, int count, Wrap w)
        { return uint32_t(w == Wrap::kRepeat ? (i % count + count) % count : std::clamp(i, 0, count - 1)); };
        std::array<float, 2> sum{};
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i)
            {
                const float weight =
                    (i == 0 ? 1 - (x - float(x0)) : x - float(x0)) * (j == 0 ? 1 - (y - float(y0)) : y - float(y0));
                const auto texel = chain.texel(level, place(x0 + i, width, wrap[0]), place(y0 + j, height, wrap[1]));
                sum[0] += weight * texel[1] / 255, sum[1] += weight * texel[2] / 255;
            }
        return sum;
    }

    void expectAsTheTwin(const SceneGpu& scene, uint32_t texture, double tolerance)
    {
        const TextureImage& image = images_[texture];
        const MipChain chain(image, {gpu::kGreen | gpu::kBlue});
        const std::vector<gpu::TexturePlace> places = placesFor(texture);
        const Buffer input = device().upload("test.places", std::span<const gpu::TexturePlace>(places));
        const Buffer output = device().array<gpu::vec4>("test.draws", kCount);
        Recorder rec(device());
        rec.begin(scene.descriptorSet());
        rec.run(testKernel("draw/texture", scene.constants()), kCount, gpu::TextureDrawParams{kCount, texture, 0},
                {{"Places", input}, {"Draws", output}});
        rec.submitAndWait();
        const auto draws = device().download<gpu::vec4>(output, kCount);
        for (uint32_t i = 0; i < kCount; ++i)
        {
            const Lookups lookups = lookupsAlong(places[i], image.width, image.height);
            if (!lookups.is_sure)
                continue;
            std::array<double, 2> mean{};
            for (double k = 0.5; k < lookups.count; ++k)
            {
                const double part = k / lookups.count - 0.5;
                const auto texel = trilinear(chain, float(lookups.level), wraps_[texture],
                                             places[i].uv.x + float(part * lookups.along_u),
                                             places[i].uv.y + float(part * lookups.along_v));
                mean[0] += texel[0] / lookups.count, mean[1] += texel[1] / lookups.count;
            }
            const std::string what = fmt::format("{} x {} at {}, {}, level {}, {} lookups", image.width, image.height,
                                                 places[i].uv.x, places[i].uv.y, lookups.level, lookups.count);
            EXPECT_NEAR(draws[i].y, mean[0], tolerance) << what;
            EXPECT_NEAR(draws[i].z, mean[1], tolerance) << what;
        }
    }

    /// A third of them points; the others up to the whole texture and beyond, of any form and direction.
    std::vector<gpu::TexturePlace> placesFor(uint32_t texture) const
    {
        std::mt19937 random(texture);
        std::uniform_real_distribution<float> uv(-2, 3), octave(-1, 1), turn(0, 2 * float(kPi));
        const float side = float(std::max(images_[texture].width, images_[texture].height));
        const auto axis = [&]
        {
            const float length = std::pow(side, octave(random)), angle = turn(random);
            return gpu::vec2{length * std::cos(angle), length * std::sin(angle)};
        };
        std::vector<gpu::TexturePlace> places;
        for (uint32_t i = 0; i < kCount; ++i)
        {
            places.push_back({.uv = {uv(random), uv(random)}, .axis_a = {}, .axis_b = {}});
            if (i % 3 > 0)
                places.back().axis_a = axis(), places.back().axis_b = axis();
        }
        return places;
    }

    static std::array<float, 2> trilinear(const MipChain& chain, float level, std::array<Wrap, 2> wrap, float u,
                                          float v)
    {
        level = std::min(level, float(chain.levels() - 1));
        const auto fine = uint32_t(level), coarse = uint32_t(std::ceil(level));
        const auto a = filtered(chain, fine, wrap, coarse, u, v), b = filtered(chain, coarse, wrap, coarse, u, v);
        const float blend = level - float(fine);
        return {a[0] + blend * (b[0] - a[0]), a[1] + blend * (b[1] - a[1])};
    }

    /// Of more sizes than there are pages, so that some are in tiles; 1 x 1, odd and narrow ones among them.
    void addManySizes()
    {
        const std::vector<std::pair<uint32_t, uint32_t>> sizes{
            {1, 1},   {2, 3},   {5, 7},   {1, 33},  {16, 16}, {17, 9},  {31, 8},  {3, 64},  {40, 40}, {48, 20},
            {50, 50}, {64, 32}, {64, 64}, {70, 30}, {80, 41}, {90, 90}, {96, 33}, {99, 12}, {24, 24}, {128, 5}};
        constexpr std::array kWraps{Wrap::kRepeat, Wrap::kClamp, Wrap::kMirror};
        for (size_t i = 0; i < sizes.size(); ++i)
            addTexture(sizes[i].first, sizes[i].second, kWraps[i % 3], kWraps[i / 3 % 3]);
    }

    static constexpr uint32_t kCount = 200;
    TemporaryFolder folder_;
    GltfBuilder gltf_;
    std::vector<TextureImage> images_;
    std::vector<std::array<Wrap, 2>> wraps_;
    ptrdiff_t tiled_ = 0; // pages
};

// Texels are stored in steps of 1/255, and samplers blend four texels and two levels in steps of 1/256 of their difference.
constexpr double kRawTolerance = 0.5 / 255 + 3.0 / 256;

TEST_F(TextureSampling, FiltersTexturesOfManySizesAsTheyAre)
{
    addManySizes();
    const auto scene = compiled(TextureCompression::kRaw);
    EXPECT_EQ(tiled_, 1);
    for (uint32_t i = 0; i < images_.size(); ++i)
        expectAsTheTwin(*scene, i, kRawTolerance);
}

TEST_F(TextureSampling, BlocksOfManySizesShowTheSame)
{
    addManySizes();
    const auto scene = compiled(TextureCompression::kBlocks);
    EXPECT_EQ(tiled_, 1);
    for (uint32_t i = 0; i < images_.size(); ++i)
        expectAsTheTwin(*scene, i,
                        kRawTolerance + 0.06); // a whole wave across 5 texels is more than lines of colours hold
}
} // namespace
