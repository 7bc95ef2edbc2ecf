// The rules of the illumination cut in double precision: what every node of a photon tree holds, whether it is divided,
// and what a node of the cut lights.
#pragma once
#include "tests/stages/gi_test.h"

#include <map>

/// What single precision may leave open.
enum class Verdict
{
    kNo,
    kOpen,
    kYes
};

/// Where a number that the kernels work out in single precision may lie.
struct Range
{
    double least = 0, most = 0;
};

/// A node of the photon tree by id: inner node i is i, photon i of n is n - 1 + i.
struct TwinNode
{
    uint32_t first, end;  // photons
    uint32_t left, right; // ids
    Double3 center;       // weighted by luminance
    Double3 mean;
    Double3 normal;     // unit
    double weight = 0;  // sum of luminances
    double noise2 = 1;  // square of the relative standard error of E~
    double longest = 0; // metres
    Range area;         // square metres
    Range irradiance;   // luminance of E~
    Verdict flat = Verdict::kYes;
    uint32_t count() const { return end - first; }
};

std::vector<TwinNode> twinNodesOf(const PhotonMap& map);

/// The parent of every node but the root.
std::map<uint32_t, uint32_t> parentsOf(const std::vector<TwinNode>& nodes);

/// Where the coarse cut divides.
struct CutRules
{
    const std::vector<TwinNode>& nodes;
    std::span<const gpu::BvhTriangle> triangles; // opaque
    bool leaves;                                 // CutMode::kLeaves
    double difference;                           // Delta_E
    uint32_t photon_count;                       // k of density estimation
    uint32_t fewest = gpu::kCutFewest;

    Verdict isUneven(uint32_t id) const;
    /// Whether a triangle stands between the halves of a node.
    Verdict isWalled(uint32_t id) const;
    /// Whether an inner node is divided though nothing below it is.
    Verdict isDivided(uint32_t id) const;
};

/// Radius of as many photons as density estimation takes, metres. @param reach metres, of density estimation
Range evenRadius(const std::vector<TwinNode>& nodes, const std::map<uint32_t, uint32_t>& parents, uint32_t id,
                 uint32_t photon_count, double reach);

/// The nodes of a cut that was not probed, by id: those of the photon tree with their centres. In the order of the cut.
std::vector<uint32_t> idsOf(const std::vector<gpu::CutNode>& cut, const std::vector<TwinNode>& nodes);

/// Expects every photon to have exactly one node of these above it.
void expectCoversEveryPhotonOnce(const std::vector<uint32_t>& ids, const std::vector<TwinNode>& nodes,
                                 size_t photon_count);

/// Metres above a node's centre; 0: infinitely far.
double eyeHeight(const gpu::CutNode& node);
bool isClear(const gpu::CutNode& node);
/// Weight of a node at a surface point x with normal n.
double cutWeight(const gpu::CutNode& node, Double3 x, Double3 n);

/// A photon that fell straight down on a surface.
gpu::Photon photonAt(gpu::vec3 position, Double3 normal, gpu::vec3 power = {1, 1, 1});

class CutTest : public GiTest
{
protected:
    static std::vector<gpu::CutNode> nodesOf(const SceneGpu& scene, const PhotonMap& map, const CutStage::Input& in);
};
