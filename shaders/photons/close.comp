#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/photons/photons.h"

// Determines which paths of an emission the map holds: all, or, if there is no room for so many photons, the first of them, as
// many as fit whole. Those are then traced again to their places; otherwise the appended photons are put in order. One thread.

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Params { StoreParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Offsets { uint offsets[]; }; // by path: photons of those before it
layout(set = 1, binding = 1, scalar) readonly buffer Total { uint total; };       // photons of all paths
layout(set = 1, binding = 2, scalar) writeonly buffer Store { PhotonStore store; };
layout(set = 1, binding = 3, scalar) writeonly buffer Size { QueueSize size; };       // photons of the map
layout(set = 1, binding = 4, scalar) writeonly buffer InOrder { QueueSize in_order; }; // appended photons to put in order
layout(set = 1, binding = 5, scalar) writeonly buffer Again { QueueSize again; };      // paths to trace again

void main()
{
    bool full = total > params.capacity;
    uint low = 0u, high = params.path_count; // offsets[low] <= capacity < offsets[high]
    while (full && high - low > 1u)
    {
        uint middle = (low + high) / 2u;
        if (offsets[middle] <= params.capacity)
            low = middle;
        else
            high = middle;
    }
    uint path_count = full ? low : params.path_count, photon_count = full ? offsets[low] : total;
    store = PhotonStore(path_count, photon_count);
    size = queueSize(photon_count);
    in_order = queueSize(full ? 0u : total);
    again = queueSize(full ? path_count : 0u);
}
