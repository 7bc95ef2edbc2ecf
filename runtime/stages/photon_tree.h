// A photon map: the photons that were stored, in the order of a tree over their positions.
#pragma once
#include "runtime/stages/photons.h"
#include "runtime/stages/tree.h"

class PhotonTreeStage
{
public:
    /// @param max_photons capacity of the photon stage it is built from
    /// @param scratch that stage's
    PhotonTreeStage(const Device& device, std::string_view name, uint32_t max_photons, const Scratch& scratch = {});

    static uint64_t scratchBytes(const Device& device, uint32_t max_photons);

    struct Output
    {
        const Buffer& size;    // gpu::QueueSize: photons
        const Buffer& photons; // gpu::Photon[size.count], sorted as the tree
        const Tree& tree;
    };
    Output record(Recorder& rec, const PhotonStage::Output& in) const;
    /// What the last record() left.
    Output output() const { return {.size = size_, .photons = sorted_, .tree = tree_}; }

private:
    Kernel keys_, reorder_;
    Tree tree_;
    Buffer size_, spheres_, sorted_;
};
