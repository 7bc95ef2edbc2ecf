// Boxes around objects that move, at a pose.
#pragma once
#include "format/package_read.h"
#include "format/pose.h"
#include "runtime/object_tree.h"

#include <array>
#include <span>
#include <vector>

class ObjectBounds
{
public:
    explicit ObjectBounds(const package::Package& package);

    /// By object. The box of what each bone moves, turned with it: of a rigid object about its bounds, of a skinned or morphed one a
    /// box that may be somewhat wide. Empty where it is hidden. Allocates nothing.
    std::span<const ObjectBox> at(const package::Pose& pose);

private:
    struct Morph // how far a weight of 1 moves some vertex of a part, at least and at most
    {
        uint32_t weight;
        std::array<float, 3> low{}, high{};
    };
    struct Part // the vertices of an object that a bone has a part in
    {
        uint32_t bone;
        ObjectBox box; // in the mesh's own space
        std::vector<Morph> morphs;
    };

    static void addMorph(Part& part, const gpu::MorphOffset& offset);
    /// Empty where the bone is hidden, or the numbers are too large.
    static ObjectBox boxAt(const Part& part, const package::Pose& pose);

    std::vector<Part> parts_;        // object after object
    std::vector<uint32_t> part_end_; // by object, in parts_
    std::vector<ObjectBox> boxes_;   // by object
};
