// The energy of the whole: within a sphere of albedo 1/2, whose wall glows with 1/2 or whose lamp lights it directly
// with 1/2, radiance is 1 everywhere, in every mode and preset, from the first frame on.
#include "shaders/lib/terms.h"
#include "tests/stages/closed_form.h"
#include "tests/stages/gi_test.h"
#include "tools/compare/distributions.h"

#include <map>

namespace
{
constexpr double kAlbedo = 0.5;
constexpr uint32_t kTiles = 4;          // each way
constexpr double kChance = 0.001;       // of a false alarm: 3.3 standard deviations of a normal distribution
constexpr double kLargestError = 0.003; // standard error of a picture's mean

const Camera kCamera{.name = "",
                     .position = {0.2f, 0.1f, -0.3f},
                     .forward = {0.6f, 0, -0.8f},
                     .up = {0, 1, 0},
                     .vertical_fov = 1.4f,
                     .orthographic_height = 0};

enum class Sphere
{
    kGlowing, // Le = 1/2: emission 1/2, direct and indirect light 1/4 each
    kLit,     // by a point light in its centre: direct and indirect light 1/2 each
};

constexpr std::initializer_list<Sphere> kBoth{Sphere::kGlowing, Sphere::kLit};

/// Means over the tiles of a square picture and, last, over all of it.
std::vector<double> tileMeans(const std::vector<double>& pixels, uint32_t side)
{
    std::vector<double> means(kTiles * kTiles + 1);
    for (uint32_t i = 0; i < side * side; ++i)
    {
        means[i / side * kTiles / side * kTiles + i % side * kTiles / side] +=
            pixels[i] * kTiles * kTiles / (side * side);
        means.back() += pixels[i] / (side * side);
    }
    return means;
}

double meanOf(const std::vector<double>& samples)
{
    double sum = 0;
    for (const double s : samples)
        sum += s;
    return sum / double(samples.size());
}

double standardError(const std::vector<double>& samples)
{
    const double n = double(samples.size()), mean = meanOf(samples);
    double squares = 0;
    for (const double s : samples)
        squares += (s - mean) * (s - mean);
    return std::sqrt(squares / (n - 1) / n);
}

/// Whether the mean of `samples` lies within `bias` of 1: Student's test of what is beyond. @return p
double studentPBeyond(const std::vector<double>& samples, double bias)
{
    // Of the truth by the midpoint rule: direct light varies by 1.5 % over a facet, on which there are 10 points or
    // more each way.
    constexpr double kRounding = 1e-4;
    const double beyond = std::abs(meanOf(samples) - 1) - bias;
    return beyond <= kRounding ? 1 : studentP(beyond / standardError(samples), double(samples.size() - 1));
}

class Energy : public GiTest
{
protected:
    static constexpr int kFacets = 16;                  // from pole to pole; all of them planar
    static constexpr uint32_t kSeeds = 4, kGiSide = 16; // pixels

    struct Facet
    {
        Double3 normal; // inwards
        double height;  // metres, of the centre over its plane
        double area;    // square metres
    };

    void open(Sphere kind)
    {
        kind_ = kind;
        builder_ = std::make_unique<SceneBuilder>();
        const nlohmann::json wall =
            kind == Sphere::kLit
                ? lambert(kAlbedo)
                : with(emitter(0.5), {{"pbrMetallicRoughness", {{"baseColorFactor", {kAlbedo, kAlbedo, kAlbedo, 1}}}}});
        builder_->sphere({0, 0, 0}, -1, kFacets, false, builder_->material(wall));
        if (kind == Sphere::kLit)
            builder_->light({{"type", "point"}, {"intensity", kPi}}, {{"translation", {0, 0, 0}}});
        const std::filesystem::path file = builder_->compile();
        scene_ = load(file);
        const auto package = package::Package::open(file);
        check(bool(package), "{}", package ? "" : package.error().message);
        std::map<uint32_t, Facet> facets; // by triangle, of which the hierarchy may hold several parts
        for (const gpu::BvhTriangle& t : package->bvhTriangles())
        {
            const Double3 a = Double3(t.v1) - Double3(t.v0), b = Double3(t.v2) - Double3(t.v0);
            const Double3 n{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; // inwards
            facets.try_emplace(t.triangle, Facet{normalized(n), -dot(Double3(t.v0), normalized(n)), length(n) / 2});
        }
        facets_.clear();
        for (const auto& [index, facet] : facets)
            facets_.push_back(facet);
        direct_ = directLight();
    }

    /// Radiance of direct light that each tile shows. The sphere is a polyhedron: at d from the lamp, on a facet whose
    /// plane is h from it, irradiance is I h / d^3.
    std::vector<double> directLight() const
    {
        constexpr uint32_t kSide = 128;
        const double extent = std::tan(double(kCamera.vertical_fov) / 2);
        const Double3 forward = normalized(kCamera.forward), right(0.8, 0, 0.6), up(0, 1, 0);
        std::vector<double> pixels;
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x)
            {
                const double across = (2 * (x + 0.5) / kSide - 1) * extent,
                             above = (1 - 2 * (y + 0.5) / kSide) * extent;
                const Double3 direction = forward + across * right + above * up, from = kCamera.position;
                double nearest = 1e30, height = 0;
                for (const Facet& f : facets_) // of a convex body the first plane from within is where the ray ends
                {
                    const double approach = -dot(direction, f.normal),
                                 distance = (dot(from, f.normal) + f.height) / approach;
                    if (approach > 0 && distance < nearest)
                        nearest = distance, height = f.height;
                }
                const double d = length(from + nearest * direction);
                pixels.push_back(kAlbedo / kPi * kPi * height / (d * d * d));
            }
        return tileMeans(pixels, kSide);
    }

    /// All light of the lamp falls on the wall: its mean direct radiance, and all reflections of it, which are even.
    double meanDirect() const
    {
        double area = 0;
        for (const Facet& f : facets_)
            area += f.area;
        return kAlbedo / kPi * 4 * kPi * kPi / area;
    }

    /// What each tile shows of a term in truth.
    std::vector<double> truth(uint32_t term) const
    {
        const bool lit = kind_ == Sphere::kLit, all = term == gpu::kTermAll;
        const double indirect = lit ? meanDirect() * kAlbedo / (1 - kAlbedo) : 0.25;
        std::vector<double> tiles(direct_.size());
        for (size_t i = 0; i < tiles.size(); ++i)
        {
            tiles[i] += (all || term == gpu::kTermEmission) && !lit ? 0.5 : 0;
            tiles[i] += all || term == gpu::kTermDirect ? (lit ? direct_[i] : 0.25) : 0;
            tiles[i] += all || term == gpu::kTermIndirect ? indirect : 0;
        }
        return tiles;
    }

    /// Renders with several seeds and expects every tile, and the whole picture, to show the truth.
    /// @param bias of it, that the mode may have
    void expectTruth(const std::string& what, Mode mode, Settings settings, uint32_t frames, uint32_t seeds,
                     double bias, uint32_t term = gpu::kTermAll)
    {
        settings.term = term;
        const std::vector<double> want = truth(term);
        std::vector<std::vector<double>> samples(want.size()); // of the truth, by tile
        double least = 1e30, most = 0;
        for (uint32_t seed = 1; seed <= (want.back() == 0 ? 1 : seeds); ++seed)
        {
            const Picture picture = mode == Mode::kGi
                                        ? renderGi(*scene_, kCamera, settings, frames, kGiSide, kGiSide, seed)
                                        : render(*scene_, kCamera, settings, frames, 64, 64, mode, seed);
            std::vector<double> pixels;
            for (const gpu::vec3& pixel : picture.pixels)
                pixels.push_back(pixel.x);
            const std::vector<double> got = tileMeans(pixels, picture.width);
            if (want.back() == 0)
            {
                EXPECT_EQ(got.back(), 0) << what;
                continue;
            }
            for (size_t i = 0; i < want.size(); ++i)
                samples[i].push_back(got[i] / want[i]);
        }
        if (want.back() == 0)
            return;
        double smallest = 1;
        for (size_t i = 0; i + 1 < samples.size(); ++i)
        {
            const double of_tile = meanOf(samples[i]);
            least = std::min(least, of_tile), most = std::max(most, of_tile);
            smallest = std::min(smallest, studentPBeyond(samples[i], bias));
        }
        const double mean = meanOf(samples.back()), p = studentPBeyond(samples.back(), bias);
        const double error = standardError(samples.back());
        fmt::print(
            "  {}: {:.4f} +- {:.4f} of the truth, tiles {:.4f} to {:.4f}; p of a bias beyond {}: {:.2g}, of any tile's "
            "{:.2g}\n",
            what, mean, error, least, most, bias, p, smallest);
        EXPECT_LE(error, kLargestError) << what << ": too few samples to tell";
        EXPECT_GE(p, kChance) << what;
        EXPECT_GE(smallest, sidakThreshold(kChance, samples.size() - 1)) << what;
    }

    /// `preset` in spheres of these kinds after each of these numbers of frames.
    void expectPreset(const char* preset, const Settings& settings, std::initializer_list<Sphere> kinds,
                      std::initializer_list<uint32_t> frame_counts, double bias)
    {
        for (const Sphere kind : kinds)
        {
            open(kind);
            const char* name = kind == Sphere::kLit ? "lit" : "glowing";
            for (const uint32_t frames : frame_counts)
                expectTruth(fmt::format("{}, {}, {} frames", preset, name, frames), Mode::kGi, settings, frames, kSeeds,
                            bias);
        }
    }

    void expectTerms(const std::string& what, Mode mode, const Settings& settings, uint32_t frames, uint32_t seeds,
                     double bias)
    {
        constexpr std::array<const char*, 6> kNames{"all", "emission", "direct", "caustics", "indirect", "glossy"};
        for (const Sphere kind : kBoth)
        {
            open(kind);
            for (uint32_t term = gpu::kTermEmission; term <= gpu::kTermGlossy; ++term)
                expectTruth(fmt::format("{}, {}, {}", what, kind == Sphere::kLit ? "lit" : "glowing", kNames[term]),
                            mode, settings, frames, seeds, bias, term);
        }
    }

    Sphere kind_ = Sphere::kLit;
    std::unique_ptr<SceneBuilder> builder_;
    std::unique_ptr<SceneGpu> scene_;
    std::vector<Facet> facets_;
    std::vector<double> direct_;
};

/// With no more irradiance samples than the 16 x 16 pixels have places for. @param part of its photons, for the sake of
/// time
Settings preset(const char* name, double part = 1)
{
    const auto settings = presetSettings(name);
    check(bool(settings), "{}", name);
    Settings result = *settings;
    result.sample_count = std::min(result.sample_count, 256u);
    result.photon_count = uint32_t(result.photon_count * part);
    return result;
}

const Settings kReference{.reference_depth = 20}; // reflections beyond are a millionth of the light

TEST_F(Energy, ReferenceKeepsIt)
{
    for (const Sphere kind : kBoth)
    {
        open(kind);
        expectTruth(kind == Sphere::kLit ? "reference, lit" : "reference, glowing", Mode::kReference, kReference, 4, 6,
                    0);
    }
}

TEST_F(Energy, ReferenceKeepsItInEachTerm)
{
    expectTerms("reference", Mode::kReference, kReference, 4, 6, 0);
}

TEST_F(Energy, PresetPreviewKeepsIt)
{
    expectPreset("preview", preset("preview"), kBoth, {1, 3}, 0.04);
}

TEST_F(Energy, PresetDefaultKeepsIt)
{
    expectPreset("default", preset("default"), {Sphere::kLit}, {1}, 0.02);
    expectPreset("default, a fifth of its photons", preset("default", 0.2), kBoth, {1, 3}, 0.02);
}

TEST_F(Energy, PresetHighKeepsIt)
{
    expectPreset("high, a twentieth of its photons", preset("high", 0.05), kBoth, {1}, 0.02);
}

TEST_F(Energy, PresetDefaultKeepsItInEachTerm)
{
    expectTerms("default, a fifth of its photons", Mode::kGi, preset("default", 0.2), 1, 12, 0.02);
}
} // namespace
