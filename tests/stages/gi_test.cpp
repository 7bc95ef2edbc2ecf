#include "tests/stages/gi_test.h"

#include <numbers>
#include <numeric>

namespace
{
struct Grid
{
    explicit Grid(const gpu::SceneInfo& info)
        : focus(0.5 * (Double3(info.bounds_min) + Double3(info.bounds_max))),
          distance(length(Double3(info.bounds_max) - Double3(info.bounds_min))), low(bent(info.bounds_min))
    {
        extent = largest(bent(info.bounds_max) - low);
    }
    Double3 bent(Double3 p) const
    {
        const Double3 d = (1 / distance) * (p - focus);
        return {std::asinh(d.x), std::asinh(d.y), std::asinh(d.z)};
    }

    Double3 focus;
    double distance;
    Double3 low;
    double extent;
};
} // namespace

Double3 gridPlace(const gpu::SceneInfo& info, Double3 p)
{
    const Grid grid(info);
    const Double3 place = (1 / grid.extent) * (grid.bent(p) - grid.low);
    return {std::clamp(place.x, 0.0, 1.0), std::clamp(place.y, 0.0, 1.0), std::clamp(place.z, 0.0, 1.0)};
}

Double3 fromGridPlace(const gpu::SceneInfo& info, Double3 place)
{
    const Grid grid(info);
    const Double3 b = grid.low + grid.extent * place;
    return grid.focus + grid.distance * Double3(std::sinh(b.x), std::sinh(b.y), std::sinh(b.z));
}

Double3 unpackedCutNormal(const gpu::CutNode& node)
{
    const auto snorm = [&](uint32_t first)
    {
        const int32_t shifted = int32_t(node.normal_and_eye << (32 - gpu::kCutNormalBits - first));
        return double(shifted >> (32 - gpu::kCutNormalBits)) / ((1 << (gpu::kCutNormalBits - 1)) - 1);
    };
    return octahedralToUnit(snorm(0), snorm(gpu::kCutNormalBits));
}

uint32_t packedCutNormal(Double3 normal)
{
    const auto [x, y] = unitToOctahedral(normal);
    const auto snorm = [](double value)
    {
        const double most = (1 << (gpu::kCutNormalBits - 1)) - 1;
        return uint32_t(int32_t(std::lround(value * most))) & ((1u << gpu::kCutNormalBits) - 1);
    };
    return snorm(x) | snorm(y) << gpu::kCutNormalBits;
}

void GiTest::submit(const SceneGpu& scene, const std::function<void(Recorder&)>& record)
{
    Recorder rec(device());
    rec.begin(scene.descriptorSet());
    record(rec);
    rec.submitAndWait();
}

TreeData GiTest::contents(const Tree& tree, uint32_t count)
{
    const uint32_t inner = count > 0 ? count - 1 : 0;
    return {.nodes = contents<gpu::TreeNode>(tree.nodes(), inner),
            .order = contents<uint32_t>(tree.order(), count),
            .leaf_parents = contents<uint32_t>(tree.leafParents(), count),
            .node_parents = contents<uint32_t>(tree.nodeParents(), inner)};
}

Buffer GiTest::sizeBuffer(uint32_t count)
{
    return upload<gpu::QueueSize>("test.size", {gpu::queueSize(count)});
}

std::unique_ptr<PhotonMap> GiTest::mapOf(const SceneGpu& scene, const std::vector<gpu::Photon>& photons)
{
    const uint32_t count = uint32_t(photons.size());
    auto map = std::make_unique<PhotonMap>(device(), scene, std::max(count, 1u));
    std::vector<uint32_t> in_order(count);
    std::iota(in_order.begin(), in_order.end(), 0);
    const Buffer on_gpu = upload("test.photons", photons), slots = upload("test.slots", in_order), none;
    const Buffer size = sizeBuffer(count);
    submit(scene,
           [&](Recorder& rec)
           {
               map->gpu.emplace(map->stage.record(rec, {.photons = on_gpu,
                                                        .slots = slots,
                                                        .size = size,
                                                        .offsets = none,
                                                        .counts = none,
                                                        .store = none,
                                                        .path_count = count,
                                                        .capacity = count}));
           });
    EXPECT_EQ(countOf(map->gpu->size), count);
    map->photons = contents<gpu::Photon>(map->gpu->photons, count);
    map->tree = contents(map->gpu->tree, count);
    return map;
}

Paths GiTest::pathsOf(const std::vector<gpu::Photon>& photons, uint32_t length)
{
    const uint32_t count = uint32_t(photons.size()), path_count = count / length;
    std::vector<uint32_t> slots(count), offsets(path_count);
    for (uint32_t i = 0; i < count; ++i)
        slots[i] = i;
    for (uint32_t i = 0; i < path_count; ++i)
        offsets[i] = i * length;
    return {.photons = upload("test.photons", photons),
            .slots = upload("test.slots", slots),
            .size = sizeBuffer(count),
            .offsets = upload("test.offsets", offsets),
            .counts = upload("test.counts", std::vector<uint32_t>(path_count, length)),
            .store =
                upload("test.store", std::vector{gpu::PhotonStore{.path_count = path_count, .photon_count = count}}),
            .path_count = path_count};
}

std::unique_ptr<Cut> GiTest::cutOf(const SceneGpu& scene, const std::vector<gpu::CutNode>& nodes,
                                   const std::function<Double3(const gpu::CutNode&)>& direction)
{
    const uint32_t count = uint32_t(nodes.size());
    std::vector<gpu::vec4> spheres;
    std::vector<uint32_t> directions;
    for (const gpu::CutNode& n : nodes)
        spheres.push_back({n.center.x, n.center.y, n.center.z, n.support});
    auto cut = std::make_unique<Cut>();
    cut->tree.emplace(device(), "test.cut_tree", std::max(count, 1u));
    cut->size = sizeBuffer(count);
    const Buffer on_gpu = upload("test.spheres", spheres);
    submit(scene, [&](Recorder& rec) { cut->tree->record(rec, on_gpu, cut->size); });
    for (const uint32_t i : contents<uint32_t>(cut->tree->order(), count))
    {
        cut->sorted.push_back(nodes[i]);
        directions.push_back(packedNormal(direction ? direction(nodes[i]) : -1 * unpackedCutNormal(nodes[i])));
    }
    cut->nodes = device().uploadTexels<gpu::CutNode>("test.cut_nodes", cut->sorted);
    cut->directions = upload("test.cut_directions", directions);
    cut->gpu.emplace(
        CutStage::Output{.size = cut->size, .nodes = cut->nodes, .directions = cut->directions, .tree = *cut->tree});
    return cut;
}

std::vector<gpu::Photon> GiTest::stored(const PhotonStage::Output& out)
{
    const auto all = contents<gpu::Photon>(out.photons, out.capacity);
    std::vector<gpu::Photon> photons;
    for (const uint32_t slot : contents<uint32_t>(out.slots, countOf(out.size)))
        photons.push_back(all.at(slot));
    return photons;
}

std::vector<gpu::Photon> GiTest::emit(const SceneGpu& scene, PhotonKind kind, const PhotonStage::Input& in,
                                      std::optional<uint32_t> capacity)
{
    const RayStage rays(device(), scene);
    const PhotonStage stage(device(), scene, kind, in.path_count, capacity.value_or(32 * in.path_count));
    submit(scene, [&](Recorder& rec) { (void)stage.record(rec, rays, in); });
    std::optional<PhotonStage::Output> out;
    submit(scene, [&](Recorder& rec) { out.emplace(stage.record(rec, rays, in)); }); // again: nothing may be left over
    return stored(*out);
}

Picture GiTest::renderGi(const SceneGpu& scene, const Camera& camera, const Settings& settings, uint32_t frame_count,
                         uint32_t width, uint32_t height, uint32_t seed)
{
    Renderer renderer(device(), scene, Mode::kGi, width, height, settings);
    Recorder rec(device());
    for (uint32_t frame = 0; frame < frame_count; ++frame)
    {
        rec.begin(scene.descriptorSet());
        renderer.record(rec, camera, settings, seed);
        rec.submitAndWait();
    }
    EXPECT_EQ(renderer.sampleCount(), frame_count);
    EXPECT_EQ(renderer.nonFiniteCount(device()), 0u);
    return {.width = width, .height = height, .pixels = renderer.picture(device())};
}

double GiTest::diagonalOf(const SceneGpu& scene)
{
    return length(Double3(scene.info().bounds_max) - Double3(scene.info().bounds_min));
}

namespace
{
struct Near
{
    double distance2;
    Double3 power;
};

Double3 estimateWithin(const std::vector<Near>& near, double radius2)
{
    Double3 sum;
    for (const Near& photon : near)
        if (photon.distance2 < radius2)
            sum = sum + std::pow(1 - photon.distance2 / radius2, 2) * photon.power;
    return 3 / (std::numbers::pi * radius2) * sum;
}
} // namespace

DensityBounds densityBounds(std::span<const gpu::Photon> photons, Double3 x, Double3 n, uint32_t wanted, double radius)
{
    std::vector<Near> near;
    for (const gpu::Photon& photon : photons)
    {
        const double distance2 = surfaceDistance2(Double3(photon.position) - x, n);
        if (distance2 < radius * radius && dot(n, unpackedNormal(photon.direction)) < 0 &&
            dot(n, unpackedNormal(photon.normal)) > 0.1)
            near.push_back({distance2, photon.power});
    }
    if (near.empty())
        return {.least = {}, .most = {}, .exact = 0};
    std::ranges::sort(near, {}, &Near::distance2);
    const double whole = radius * radius;
    const auto distance2 = [&](size_t i) { return i < near.size() ? near[i].distance2 : whole; };
    // Three histograms of 32 bins, each over one bin of the one before; none more once the bin's rim holds k + k/16.
    const double low = near.size() < wanted ? whole : distance2(wanted - 1);
    const double high = std::max(std::min(low + whole / 32768, whole), distance2(wanted + wanted / 16));
    const Double3 exact = estimateWithin(near, low);
    DensityBounds bounds{.least = exact, .most = exact, .exact = luminanceOf(exact)};
    constexpr int kSteps = 64;
    for (int step = 1; step <= kSteps; ++step)
    {
        const Double3 value = estimateWithin(near, low + (high - low) * step / kSteps);
        bounds.least = min(bounds.least, value);
        bounds.most = max(bounds.most, value);
    }
    return bounds;
}

nlohmann::json mirror(double r, double g, double b)
{
    return {
        {"pbrMetallicRoughness", {{"baseColorFactor", {r, g, b, 1}}, {"metallicFactor", 1}, {"roughnessFactor", 0}}}};
}

Settings smallSettings()
{
    Settings settings;
    settings.photon_count = 2000;
    settings.photon_capacity = 32000;
    settings.density_photons = 25;
    settings.density_radius = 0.1f; // so few photons lie far apart
    settings.sample_count = 128;
    settings.gather_rays = 32;
    settings.caustic_photons = 1000;
    settings.caustic_density_photons = 50;
    return settings;
}
