// Our pictures against those of an independent renderer (Cycles), kept beside the repository in shared/references.
// Noise is estimated from our own pictures: two halves with different seeds, a and b, make the picture m = (a + b) / 2,
// and (a - b)^2 / 4 is an unbiased estimate of m's variance, pixel by pixel.
#include "compiler/compile.h"
#include "image/read_exr.h"
#include "runtime/renderer.h"
#include "tests/stages/double3.h"
#include "tests/stages/gpu_test.h"
#include "tests/stages/mean_fresnel.h"
#include "tests/stages/same_picture.h"
#include "tests/tools/temporary_folder.h"
#include "tools/compare/metrics.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>

namespace
{
const std::filesystem::path kShared = LUMICUT_SHARED_DIR;

struct Comparison
{
    std::string scene;          // below shared/scenes
    std::string reference;      // below shared/references
    uint32_t reference_samples; // a pixel
    uint32_t samples;           // ours, a pixel, both halves together
    bool lambert = false;       // take the specular layer off every material first
};

// ---- The scene -----------------------------------------------------------------------------------------------------

uint32_t wordAt(const std::string& bytes, size_t at)
{
    uint32_t word;
    std::memcpy(&word, bytes.data() + at, 4);
    return word;
}

std::string wordBytes(uint32_t word)
{
    return {reinterpret_cast<const char*>(&word), 4};
}

/// The same binary glTF with KHR_materials_specular on every material, all factors 0: what remains is Lambert.
std::string withoutSpecular(const std::string& glb)
{
    constexpr size_t kHeader = 12, kChunkHeader = 8;
    const uint32_t json_bytes = wordAt(glb, kHeader);
    nlohmann::json json = nlohmann::json::parse(glb.substr(kHeader + kChunkHeader, json_bytes));
    for (auto& material : json["materials"])
        material["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0}, {"specularColorFactor", {0, 0, 0}}};
    json["extensionsUsed"].push_back("KHR_materials_specular");
    std::string text = json.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    const std::string rest = glb.substr(kHeader + kChunkHeader + json_bytes);
    return glb.substr(0, 8) + wordBytes(uint32_t(kHeader + kChunkHeader + text.size() + rest.size())) +
           wordBytes(uint32_t(text.size())) + glb.substr(kHeader + 4, 4) + text + rest;
}

package::Package compiledScene(const Comparison& c)
{
    const TemporaryFolder folder;
    std::filesystem::path input = kShared / "scenes" / c.scene;
    if (c.lambert)
    {
        std::ofstream(folder / "lambert.glb", std::ios::binary) << withoutSpecular(fileBytes(input));
        input = folder / "lambert.glb";
    }
    const auto report =
        compile({.input = input, .output = folder / "scene.lumi", .textures = TextureCompression::kRaw});
    check(report, "{}: {}", c.scene, report.error().message);
    auto package = package::Package::open(folder / "scene.lumi");
    check(package, "{}", package.error().message);
    return std::move(*package);
}

// ---- Our picture ---------------------------------------------------------------------------------------------------

std::vector<gpu::vec3> renderHalf(const Device& device, const SceneGpu& scene, const Camera& camera, uint32_t width,
                                  uint32_t height, uint32_t samples, uint32_t seed)
{
    Renderer renderer(device, scene, Mode::kReference, width, height);
    Recorder rec(device);
    while (renderer.sampleCount() < samples)
    {
        rec.begin(scene.descriptorSet());
        renderer.record(rec, camera, Settings(), seed, std::min(samples - renderer.sampleCount(), renderer.maxBatch()));
        rec.submitAndWait();
    }
    EXPECT_EQ(renderer.nonFiniteCount(device), 0u);
    return renderer.picture(device);
}

struct Pictures
{
    ImageF reference, ours;
    std::vector<double> variance; // of ours, per value
};

Pictures renderBoth(const Device& device, const SceneGpu& scene, const Camera& camera, const Comparison& c)
{
    auto reference = readExr(kShared / "references" / c.reference);
    check(reference, "{}: {}", c.reference, reference.error().message);
    Pictures p{.reference = std::move(*reference), .ours = {}, .variance = {}};
    const uint32_t width = p.reference.width, height = p.reference.height;
    p.ours = imageOf(width, height, renderHalf(device, scene, camera, width, height, c.samples / 2, 1));
    const ImageF other = imageOf(width, height, renderHalf(device, scene, camera, width, height, c.samples / 2, 2));
    for (size_t i = 0; i < other.rgb.size(); ++i)
    {
        const double a = p.ours.rgb[i], b = other.rgb[i];
        p.variance.push_back((a - b) * (a - b) / 4);
        p.ours.rgb[i] = float((a + b) / 2);
    }
    return p;
}

// ---- Comparing -----------------------------------------------------------------------------------------------------

/// Makes both pictures black, hence equal, where `left_out` is set.
void blacken(Pictures& p, const std::vector<bool>& left_out)
{
    for (size_t i = 0; i < p.variance.size(); ++i)
        if (left_out[i / 3])
        {
            p.variance[i] = 0;
            p.reference.rgb[i] = p.ours.rgb[i] = 0;
        }
}

/// relMSE that noise alone explains. The reference's variance is taken as ours times samples / reference_samples.
double expectedRelMse(const Pictures& p, const Comparison& c)
{
    double sum = 0;
    for (size_t i = 0; i < p.variance.size(); ++i)
    {
        const double r = p.reference.rgb[i];
        sum += p.variance[i] * (1 + double(c.samples) / c.reference_samples) / (r * r + kRelMseEpsilon);
    }
    return sum / double(p.variance.size());
}

struct Outcome
{
    Metrics metrics;
    double expected_relmse;
};

Outcome compareAndPrint(const Pictures& p, const Comparison& c, const std::string& what)
{
    const Outcome o{.metrics = compareImages(p.reference, p.ours), .expected_relmse = expectedRelMse(p, c)};
    fmt::print("{}, {}: mean ratio {:.4f} {:.4f} {:.4f}, bias z {:.2f}, relMSE {:.5f}, {:.5f} expected of noise\n",
               c.reference, what, o.metrics.mean_ratio[0], o.metrics.mean_ratio[1], o.metrics.mean_ratio[2],
               o.metrics.bias_z, o.metrics.relmse, o.expected_relmse);
    return o;
}

/// Means within 1 % of the reference's, but for two standard errors, and no more difference than noise makes. Rare bright samples raise both sides
/// of that alike; what is left to guess is the reference's own noise, 6 % of all at most, hence the factor.
void expectAgreement(const Outcome& o)
{
    constexpr double kMeanTolerance = 0.01, kNoiseFactor = 1.1;
    const auto& ratios = o.metrics.mean_ratio;
    const double off = (ratios[0] + ratios[1] + ratios[2]) / 3 - 1,
                 standard_error = o.metrics.bias_z != 0 ? std::abs(off / o.metrics.bias_z) : 0;
    for (const double ratio : ratios)
        EXPECT_NEAR(ratio, 1, kMeanTolerance + 2 * standard_error);
    EXPECT_LE(o.metrics.relmse, kNoiseFactor * o.expected_relmse);
}

struct Opened
{
    package::Package package;
    std::unique_ptr<SceneGpu> scene;
    Camera camera;
};

Opened openScene(const Device& device, const Comparison& c)
{
    package::Package package = compiledScene(c);
    auto scene = SceneGpu::create(device, package);
    check(scene, "{}", scene.error().message);
    const Camera camera = packageCameras(package).front();
    return {.package = std::move(package), .scene = std::move(*scene), .camera = camera};
}

// ---- Surfaces in one place -----------------------------------------------------------------------------------------
// Where two surfaces that face each other coincide exactly, as the sides of neighbouring tiles do, Cycles shadows each
// with the other; we do not. Pixels that show such surfaces are left out.

struct Dvec
{
    double x, y, z;
};
Dvec operator-(gpu::vec3 a, gpu::vec3 b)
{
    return {double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z};
}
double dot(Dvec a, Dvec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Dvec cross(Dvec a, Dvec b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Dvec unitNormal(const gpu::BvhTriangle& t)
{
    const Dvec n = cross(t.v1 - t.v0, t.v2 - t.v0);
    const double length = std::sqrt(dot(n, n));
    return {n.x / length, n.y / length, n.z / length};
}

constexpr double kCoincident = 1e-4; // metres

/// Triangles in the plane of `triangle`, facing the other way.
std::vector<uint32_t> opposites(std::span<const gpu::BvhTriangle> triangles, std::span<const Dvec> normals,
                                uint32_t triangle)
{
    std::vector<uint32_t> found;
    const gpu::vec3 at = triangles[triangle].v0;
    for (uint32_t i = 0; i < triangles.size(); ++i)
        if (dot(normals[i], normals[triangle]) < -0.9999 &&
            std::abs(dot(triangles[i].v0 - at, normals[triangle])) < kCoincident)
            found.push_back(i);
    return found;
}

bool contains(const gpu::BvhTriangle& t, Dvec normal, gpu::vec3 point)
{
    const auto inside = [&](gpu::vec3 a, gpu::vec3 b)
    {
        const Dvec edge = b - a;
        return dot(cross(edge, point - a), normal) > -kCoincident * std::sqrt(dot(edge, edge));
    };
    return inside(t.v0, t.v1) && inside(t.v1, t.v2) && inside(t.v2, t.v0);
}

/// What `samples` rays through every pixel of `camera` meet first.
struct FirstHits
{
    std::vector<gpu::Ray> rays; // rays[i] belongs to pixel i % (width * height)
    std::vector<gpu::Hit> hits;
};

FirstHits firstHits(const Device& device, const SceneGpu& scene, const Camera& camera, uint32_t width, uint32_t height,
                    uint32_t samples)
{
    const uint32_t count = width * height * samples;
    const RayStage stage(device, scene);
    const Kernel generate = device.kernel("primary/generate");
    const RayQueue queue(device, "test.queue", count);
    const Buffer hits = device.array<gpu::Hit>("test.hits", count);
    gpu::CameraParams view = cameraParams(camera, width, height);
    view.sample_count = samples;
    Recorder rec(device);
    rec.begin(scene.descriptorSet());
    stage.resize(rec, queue.size, count);
    rec.run(generate, count, view, {{"Rays", queue.rays}});
    stage.closest(rec, queue, hits, 0);
    rec.submitAndWait();
    // The kernel makes them tile by tile.
    const std::vector<gpu::Ray> rays = device.download<gpu::Ray>(queue.rays, count);
    const std::vector<gpu::Hit> met = device.download<gpu::Hit>(hits, count);
    FirstHits first{.rays = std::vector<gpu::Ray>(count), .hits = std::vector<gpu::Hit>(count)};
    for (uint32_t i = 0; i < count; ++i)
    {
        first.rays[rays[i].path] = rays[i];
        first.hits[rays[i].path] = met[i];
    }
    return first;
}

/// Whether the triangle's vertex normals make it a part of something round. The other renderer cuts light off where the facet
/// turns away from it, ours where the round surface does.
bool isRound(const package::Package& package, const gpu::BvhTriangle& triangle, Dvec normal)
{
    constexpr double kFlat = 0.9998; // cosine of 1 degree: normals are rounded to less
    const gpu::uvec3 v = package.triangles()[triangle.triangle].vertices;
    for (const uint32_t vertex : {v.x, v.y, v.z})
    {
        const Double3 n = unpackedNormal(package.vertexAttributes()[vertex].normal);
        if (std::abs(n.x * normal.x + n.y * normal.y + n.z * normal.z) < kFlat)
            return true;
    }
    return false;
}

/// Pixels that show a surface which coincides with one that faces the other way or a facet of something round, and their
/// neighbours.
std::vector<bool> differingPixels(const Device& device, const Opened& opened, uint32_t width, uint32_t height)
{
    constexpr uint32_t kRaysPerPixel = 8;
    const FirstHits first = firstHits(device, *opened.scene, opened.camera, width, height, kRaysPerPixel);
    const auto triangles = opened.package.bvhTriangles();
    std::vector<Dvec> normals;
    for (const gpu::BvhTriangle& t : triangles)
        normals.push_back(unitNormal(t));
    std::map<uint32_t, std::vector<uint32_t>> opposites_of;
    std::vector<bool> marked(size_t(width) * height);
    for (size_t i = 0; i < first.hits.size(); ++i)
    {
        const uint32_t slot = first.hits[i].slot;
        if (slot == gpu::kNone)
            continue;
        const auto [entry, is_new] = opposites_of.try_emplace(slot);
        if (is_new)
            entry->second = opposites(triangles, normals, slot);
        const gpu::vec3 point = first.rays[i].origin + first.hits[i].t * first.rays[i].direction;
        if (isRound(opened.package, triangles[slot], normals[slot]))
            marked[i % marked.size()] = true;
        for (const uint32_t other : entry->second)
            if (contains(triangles[other], normals[other], point))
                marked[i % marked.size()] = true;
    }
    std::vector<bool> grown(marked.size());
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (uint32_t ny = y - (y > 0); ny <= std::min(y + 1, height - 1); ++ny)
                for (uint32_t nx = x - (x > 0); nx <= std::min(x + 1, width - 1); ++nx)
                    grown[y * width + x] = grown[y * width + x] || marked[ny * width + nx];
    return grown;
}

class References : public GpuTest
{
protected:
    void SetUp() override
    {
        if (!std::filesystem::exists(kShared / "references"))
            GTEST_SKIP() << "shared references not found";
        GpuTest::SetUp();
    }

    void expectAgreementWith(const Comparison& c)
    {
        const Opened opened = openScene(device(), c);
        expectAgreement(compareAndPrint(renderBoth(device(), *opened.scene, opened.camera, c), c, "whole picture"));
    }
};

TEST_F(References, CornellBoxOfLambertSurfaces)
{
    expectAgreementWith({.scene = "truth/cornell.glb",
                         .reference = "cornell_lambert_256_4096.exr",
                         .reference_samples = 4096,
                         .samples = 32});
}

TEST_F(References, CornellBoxWithGlassMirrorAndGlossyMetal)
{
    expectAgreementWith({.scene = "truth/cornell_caustic.glb",
                         .reference = "cornell_caustic_gltf_256_2048.exr",
                         .reference_samples = 2048,
                         .samples = 32});
}

TEST_F(References, CornellBoxOfAnotherMaker)
{
    expectAgreementWith({.scene = "scenes/cornell-cc0.glb",
                         .reference = "cornell_cc0_lambert_256_1024.exr",
                         .reference_samples = 1024,
                         .samples = 32,
                         .lambert = true});
}

/// What the stand-in for glTF's BRDF changes in a picture's direct light, pixel by pixel: stand-in minus glTF.
std::vector<gpu::vec3> changeOfDirectLight(const Device& device, const Opened& opened, uint32_t width, uint32_t height)
{
    constexpr uint32_t kRaysPerPixel = 8;
    const FirstHits first = firstHits(device, *opened.scene, opened.camera, width, height, kRaysPerPixel);
    const DirectLightByBothModels direct_light(opened.package);
    const RayStage stage(device, *opened.scene);
    std::vector<gpu::vec3> change(size_t(width) * height);
    for (const gpu::Light& light : opened.package.lights())
    {
        std::vector<gpu::ShadowRay> shadow_rays;
        for (uint32_t i = 0; i < first.hits.size(); ++i)
            if (first.hits[i].slot != gpu::kNone)
                if (const auto lit = direct_light(first.rays[i], first.hits[i], light))
                {
                    const gpu::vec3 difference = lit->mean_fresnel + -1.0f * lit->gltf;
                    shadow_rays.push_back(
                        {.ray = lit->shadow_ray, .radiance = (1.0f / kRaysPerPixel) * difference, .unused = 0});
                    shadow_rays.back().ray.path = i;
                }
        const Buffer size = device.array<gpu::QueueSize>("test.size", 1);
        const Buffer queue = device.uploadTexels<gpu::ShadowRay>("test.shadow_rays", shadow_rays);
        const Buffer arrived = device.array<gpu::vec3>("test.arrived", first.hits.size());
        Recorder rec(device);
        rec.begin(opened.scene->descriptorSet());
        rec.clear(arrived);
        stage.resize(rec, size, uint32_t(shadow_rays.size()));
        stage.visible(rec, size, queue, arrived);
        rec.submitAndWait();
        const auto values = device.download<gpu::vec3>(arrived, first.hits.size());
        for (size_t i = 0; i < values.size(); ++i)
            change[i % change.size()] = change[i % change.size()] + values[i];
    }
    return change;
}

struct Hall
{
    Opened opened;
    Pictures pictures; // without pixels on coincident surfaces and on facets of something round
    std::vector<bool> left_out;
};

/// Renders the hall; prints what the whole picture gives.
Hall renderHall(const Device& device, const Comparison& c)
{
    Opened opened = openScene(device, c);
    Pictures pictures = renderBoth(device, *opened.scene, opened.camera, c);
    compareAndPrint(pictures, c, "whole picture");
    std::vector<bool> left_out = differingPixels(device, opened, pictures.ours.width, pictures.ours.height);
    fmt::print("  {} of {} pixels left out\n", std::ranges::count(left_out, true), left_out.size());
    blacken(pictures, left_out);
    return {.opened = std::move(opened), .pictures = std::move(pictures), .left_out = std::move(left_out)};
}

TEST_F(References, DungeonHallOfLambertSurfaces)
{
    const Comparison c{.scene = "scenes/dungeon-hall-cc0.glb",
                       .reference = "dungeon_hall_lambert_320x180_1024.exr",
                       .reference_samples = 1024,
                       .samples = 32,
                       .lambert = true};
    const Hall hall = renderHall(device(), c);
    expectAgreement(compareAndPrint(hall.pictures, c, "without coincident surfaces and round ones"));
}

TEST_F(References, DungeonHall)
{
    const Comparison c{.scene = "scenes/dungeon-hall-cc0.glb",
                       .reference = "dungeon_hall_gltf_320x180_512.exr",
                       .reference_samples = 512,
                       .samples = 32};
    Hall hall = renderHall(device(), c);
    compareAndPrint(hall.pictures, c, "without coincident surfaces and round ones");
    const ImageF& ours = hall.pictures.ours;
    const auto change = changeOfDirectLight(device(), hall.opened, ours.width, ours.height);
    for (size_t i = 0; i < change.size(); ++i)
        if (!hall.left_out[i])
            for (size_t k = 0; k < 3; ++k)
                hall.pictures.ours.rgb[3 * i + k] += k == 0 ? change[i].x : k == 1 ? change[i].y : change[i].z;
    expectAgreement(compareAndPrint(hall.pictures, c, "and with Cycles' stand-in for the BRDF in the direct light"));
}
} // namespace
