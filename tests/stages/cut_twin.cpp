#include "tests/stages/cut_twin.h"

#include "tests/stages/brute_force.h"

#include <numbers>

namespace
{
// Some single roundings of coordinates of about a metre, metres: what the kernels' means may be off by.
constexpr double kMeanError = 5e-7;
constexpr double kSumError = 1e-6; // relative, of sums over photons

Verdict verdict(double value, double slack) // whether value > 0
{
    return value > slack ? Verdict::kYes : value < -slack ? Verdict::kNo : Verdict::kOpen;
}

Verdict negated(Verdict v)
{
    return Verdict(int(Verdict::kYes) - int(v));
}

/// Two unit vectors across n.
std::array<Double3, 2> across(Double3 n)
{
    const auto product = [](Double3 a, Double3 b)
    { return Double3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); };
    const Double3 u = normalized(product(n, std::abs(n.x) < 0.6 ? Double3(1, 0, 0) : Double3(0, 1, 0)));
    return {u, product(n, u)};
}

/// Everything but the ids.
void measure(TwinNode& node, std::span<const gpu::Photon> photons)
{
    const double n = double(photons.size());
    Double3 normals, places, mean;
    double squares = 0;
    for (const gpu::Photon& photon : photons)
    {
        const double w = luminanceOf(photon.power);
        node.weight += w;
        squares += w * w;
        normals = normals + unpackedNormal(photon.normal);
        places = places + w * Double3(photon.position);
        mean = mean + (1 / n) * Double3(photon.position);
    }
    node.mean = mean;
    node.center = photons.size() == 1 ? mean : (1 / node.weight) * places;
    node.normal = normalized(normals);
    if (photons.size() == 1)
        return;
    node.noise2 = squares / (node.weight * node.weight) + 1 / n;
    const auto [u, v] = across(node.normal);
    double uu = 0, uv = 0, vv = 0, along = 0;
    for (const gpu::Photon& photon : photons)
    {
        const Double3 d = Double3(photon.position) - mean;
        uu += dot(d, u) * dot(d, u);
        uv += dot(d, u) * dot(d, v);
        vv += dot(d, v) * dot(d, v);
        along += dot(d, node.normal) * dot(d, node.normal);
    }
    node.longest = std::sqrt(6 * (uu + vv) / n);
    // A product of differences from the mean, each off by kMeanError, and the sum's rounding.
    const double sum = uu + vv + along,
                 error = kSumError * sum + 2 * kMeanError * std::sqrt(n * sum) + n * kMeanError * kMeanError;
    const auto area = [&](double determinant)
    { return n < 3 ? 0 : 12 * std::sqrt(std::max(determinant, 0.0) / ((n - 1) * (n - 2))); };
    const double determinant = uu * vv - uv * uv, determinant_error = error * (2 * sum + error);
    node.area = {area(determinant - determinant_error), area(determinant + determinant_error)};
    node.irradiance = {node.weight / std::max(node.area.most, 1e-20), node.weight / std::max(node.area.least, 1e-20)};
    // kFacingApart and kBent of lib/photon_node.glsl.
    node.flat = std::min(verdict(0.3 - (n - length(normals)), kSumError * n), verdict(0.02 * (uu + vv) - along, error));
}
} // namespace

std::vector<TwinNode> twinNodesOf(const PhotonMap& map)
{
    const uint32_t count = uint32_t(map.photons.size());
    const auto idOf = [&](uint32_t child)
    { return (child & gpu::kTreeLeafBit) != 0 ? (child & ~gpu::kTreeLeafBit) + count - 1 : child; };
    std::vector<TwinNode> nodes;
    for (const gpu::TreeNode& n : map.tree.nodes)
        nodes.push_back({.first = n.first, .end = n.first + n.count, .left = idOf(n.left), .right = idOf(n.right)});
    for (uint32_t i = 0; i < count; ++i)
        nodes.push_back({.first = i, .end = i + 1, .left = 0, .right = 0});
    for (TwinNode& node : nodes)
        measure(node, std::span(map.photons).subspan(node.first, node.count()));
    return nodes;
}

std::map<uint32_t, uint32_t> parentsOf(const std::vector<TwinNode>& nodes)
{
    std::map<uint32_t, uint32_t> parents;
    for (uint32_t id = 0; id < nodes.size(); ++id)
        if (nodes[id].count() > 1)
            parents[nodes[id].left] = parents[nodes[id].right] = id;
    return parents;
}

Verdict CutRules::isUneven(uint32_t id) const
{
    const TwinNode *a = &nodes[nodes[id].left], *b = &nodes[nodes[id].right];
    if (a->count() < b->count())
        std::swap(a, b);
    if (b->count() < 4) // kFewestCompared
        b = &nodes[id];
    double least = 1e300, most = -1e300;
    for (const double e : {a->irradiance.least, a->irradiance.most})
        for (const double f : {b->irradiance.least, b->irradiance.most})
        {
            const double chance = 3 * std::sqrt(e * e * a->noise2 + f * f * b->noise2); // kBeyondChance
            const double beyond = (std::abs(e - f) - std::max(difference * std::max(e, f), chance)) / std::max(e, f);
            least = std::min(least, beyond);
            most = std::max(most, beyond);
        }
    return least > kSumError ? Verdict::kYes : most < -kSumError ? Verdict::kNo : Verdict::kOpen;
}

Verdict CutRules::isWalled(uint32_t id) const
{
    const TwinNode& node = nodes[id];
    const Double3 a = nodes[node.left].center, b = nodes[node.right].center;
    const double distance = length(b - a);
    if (distance <= 2 * kMeanError)
        return Verdict::kOpen;
    const Double3 origin = a + gpu::kProbeHeight * std::max(node.longest, 0.5 * distance) * node.normal;
    const Double3 direction = (1 / distance) * (b - a);
    // The kernel's ray is off by roundings: so far to every side, all must meet something, or none may.
    bool all = true, any = false;
    for (const Double3 off : {Double3(0, 0, 0), Double3(1, 0, 0), Double3(-1, 0, 0), Double3(0, 1, 0),
                              Double3(0, -1, 0), Double3(0, 0, 1), Double3(0, 0, -1)})
    {
        const Double3 o = origin + 4 * kMeanError * off;
        const gpu::Ray ray{.origin = {float(o.x), float(o.y), float(o.z)},
                           .t_max = float(distance),
                           .direction = {float(direction.x), float(direction.y), float(direction.z)},
                           .path = 0};
        const auto found = meetings(ray, triangles);
        any = any || !found.empty();
        all = all && std::ranges::any_of(found, [](const Meeting& m) { return m.certain && !m.ends_on_it; });
    }
    return all ? Verdict::kYes : any ? Verdict::kOpen : Verdict::kNo;
}

Verdict CutRules::isDivided(uint32_t id) const
{
    Verdict divided = negated(nodes[id].flat);
    if (nodes[id].count() > (leaves ? fewest : std::max(fewest, gpu::kCutMost * photon_count)))
        return Verdict::kYes;
    if (nodes[id].count() > fewest)
        divided = std::max(divided, isUneven(id));
    return divided == Verdict::kYes ? divided : std::max(divided, isWalled(id));
}

Range evenRadius(const std::vector<TwinNode>& nodes, const std::map<uint32_t, uint32_t>& parents, uint32_t id,
                 uint32_t photon_count, double reach)
{
    while (nodes[id].count() <= gpu::kCutFewest)
    {
        if (id == 0)
            return {reach, reach};
        id = parents.at(id);
    }
    const auto radius = [&](double area)
    { return std::min(reach, std::sqrt(area * photon_count / nodes[id].count() / std::numbers::pi)); };
    return {radius(nodes[id].area.least), radius(nodes[id].area.most)};
}

std::vector<uint32_t> idsOf(const std::vector<gpu::CutNode>& cut, const std::vector<TwinNode>& nodes)
{
    std::vector<uint32_t> ids;
    for (const gpu::CutNode& c : cut)
    {
        uint32_t best = 0;
        double nearest = 1e30;
        for (uint32_t id = 0; id < nodes.size(); ++id)
            if (const double d2 = length2(Double3(c.center) - nodes[id].center); d2 < nearest)
                nearest = d2, best = id;
        EXPECT_LT(nearest, 1e-10) << "a centre 10 micrometres from every node's";
        EXPECT_GT(dot(nodes[best].normal, unpackedCutNormal(c)), 0.9999);
        ids.push_back(best);
    }
    return ids;
}

void expectCoversEveryPhotonOnce(const std::vector<uint32_t>& ids, const std::vector<TwinNode>& nodes,
                                 size_t photon_count)
{
    std::vector<uint32_t> covered(photon_count);
    for (const uint32_t id : ids)
        for (uint32_t i = nodes[id].first; i < nodes[id].end; ++i)
            ++covered[i];
    EXPECT_EQ(covered, std::vector<uint32_t>(photon_count, 1));
}

double eyeHeight(const gpu::CutNode& node)
{
    const uint32_t step = node.normal_and_eye >> (2 * gpu::kCutNormalBits) & gpu::kCutEyeSteps;
    return double(step) / gpu::kCutEyeSteps * gpu::kProbeHeight * node.support;
}

bool isClear(const gpu::CutNode& node)
{
    return (node.normal_and_eye & gpu::kCutIsClear) != 0;
}

double cutWeight(const gpu::CutNode& node, Double3 x, Double3 n)
{
    const Double3 normal = unpackedCutNormal(node), d = x - node.center;
    const double along = dot(d, normal), eye = eyeHeight(node), support2 = double(node.support) * node.support;
    if (length2(d) >= support2 || dot(n, normal) <= 0.2 || (eye > 0 && along >= 0.9 * eye))
        return 0;
    const Double3 across = d - along * normal;
    const double onto_plane = eye > 0 ? eye / (eye - along) : 1; // where the ray from the eye through x meets the plane
    return std::max(0.0, 1 - (onto_plane * onto_plane * length2(across) + 16 * along * along) / support2);
}

gpu::Photon photonAt(gpu::vec3 position, Double3 normal, gpu::vec3 power)
{
    return {
        .position = position, .direction = packedNormal(-1 * normal), .power = power, .normal = packedNormal(normal)};
}

std::vector<gpu::CutNode> CutTest::nodesOf(const SceneGpu& scene, const PhotonMap& map, const CutStage::Input& in)
{
    const CutStage stage(device(), scene, uint32_t(map.photons.size()));
    std::optional<CutStage::Output> out;
    submit(scene, [&](Recorder& rec) { out.emplace(stage.record(rec, map.rays, *map.gpu, in)); });
    return contents<gpu::CutNode>(out->nodes, countOf(out->size));
}
