// The photons that one emission has left.
#pragma once
#include "runtime/gpu/gpu.h"
#include "shaders/photons/photons.h"

struct StoredPhotons
{
    const Buffer& photons; // gpu::Photon[capacity]
    const Buffer& slots;   // uint[size.count]: where they are, path by path, each path from its light on
    const Buffer& size;    // gpu::QueueSize: photons
    const Buffer& offsets; // uint[path_count]: photons of the paths before
    const Buffer& counts;  // uint[path_count]: of the path
    const Buffer& store;   // gpu::PhotonStore: what is in it where not every path found room
    uint32_t path_count;   // that were emitted
    uint32_t capacity;     // photons that there is room for
};
