// The illumination cut: a set of photon-tree nodes, one above every photon, whose irradiance represents the whole map.
#pragma once
#include "runtime/stages/photon_tree.h"
#include "shaders/cut/cut.h"

enum class CutMode : uint32_t
{
    kKnn = gpu::kCutKnn,
    kNearest = gpu::kCutNearest,
    kLeaves = gpu::kCutLeaves,
    kRefined = gpu::kCutRefined
};

class CutStage
{
public:
    /// @param max_photons in the map at most
    CutStage(const Device& device, const SceneGpu& scene, uint32_t max_photons, const Scratch& scratch = {});

    struct Input
    {
        CutMode mode;
        uint32_t iterations;   // of refinement
        float difference;      // Delta_E, relative
        uint32_t photon_count; // k of density estimation
        float radius;          // of density estimation at most: of the distance from the viewer
        float shrink; // of the nodes' supports, <= 1: in a static view noise averages out, so that they may be sharp
        uint32_t fewest =
            gpu::kCutFewest; // photons of a node that is not divided further: less where supports have shrunk
        uint32_t probes; // coverage probe rays of a node; 0: its surroundings are assumed to be a plane without walls
        uint32_t rim_probes =
            0; // additional rays that find nodes whose lookups need no visibility ray: worth it where lookups are many
        uint32_t seed;
        bool operator==(const Input&) const = default; // equal input over one map gives one cut
    };
    struct Output
    {
        const Buffer& size;  // gpu::QueueSize: nodes of the cut
        const Buffer& nodes; // gpu::CutNode[size.count], sorted as the tree
        const Buffer&
            directions;   // uint32_t[size.count]: octahedral, the way that light arrives at a node: one photon's
        const Tree& tree; // over their supports
    };
    Output record(Recorder& rec, const RayStage& rays, const PhotonTreeStage::Output& map, const Input& in) const;
    /// Nodes of the last record()'s cut; waits for the device.
    uint32_t nodeCount(const Device& device) const { return device.download<gpu::QueueSize>(size_, 1)[0].count; }
    /// What the last record() left.
    Output output() const { return {.size = size_, .nodes = nodes_, .directions = directions_, .tree = tree_}; }

private:
    Kernel reduce_upward_, coarse_, select_, refine_, reorder_, build_leaves_, probe_, keys_, sample_direction_;
    Compaction compaction_;
    Tree tree_;
    Buffer sums_, arrivals_, id_count_, divided_, work_, next_work_, work_size_, next_work_size_, members_, finals_;
    Buffer size_, ids_, spheres_, nodes_, unsorted_directions_, directions_;
    Buffer probe_size_; // gpu::QueueSize: threads of probe_, and how many rays they trace
};
