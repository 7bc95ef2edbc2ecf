// The illumination cut: a set of photon-tree nodes, one above every photon, whose irradiance stands for the whole map.
#pragma once
#include "runtime/stages/photon_tree.h"
#include "shaders/cut/cut.h"

enum class CutMode : uint32_t { kKnn = gpu::kCutKnn, kNearest = gpu::kCutNearest, kLeaves = gpu::kCutLeaves, kRefined = gpu::kCutRefined };

class CutStage
{
public:
    /// @param max_photons in the map at most
    CutStage(const Device& device, uint32_t max_photons);

    struct Input
    {
        CutMode mode;
        uint32_t iterations;  // of refinement
        float difference;     // Delta_E, relative
        uint32_t photon_count; // k of density estimation
        float radius;         // metres, of density estimation at most
        bool operator==(const Input&) const = default; // equal input over one map gives one cut
    };
    struct Output
    {
        const Buffer& size;  // gpu::QueueSize: nodes of the cut
        const Buffer& nodes; // gpu::CutNode[size.count], sorted as the tree
        const Tree& tree;    // over their supports
    };
    Output record(Recorder& rec, const RayStage& rays, const PhotonTreeStage::Output& map, const Input& in) const;
    /// What the last record() left.
    Output output() const { return {.size = size_, .nodes = nodes_, .tree = tree_}; }

private:
    Kernel summarise_, level_mean_, threshold_kernel_, coarse_, select_, refine_, collect_, reorder_;
    Compaction compaction_;
    Tree tree_;
    Buffer sums_, arrivals_, partials_, threshold_, id_count_, divided_, work_, next_work_, work_size_, next_work_size_, members_, finals_;
    Buffer size_, ids_, spheres_, nodes_;
};
