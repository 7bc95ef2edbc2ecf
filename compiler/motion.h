// From the animations of a file to the tables of a package's MOTN chunk.
#pragma once
#include "compiler/gltf_animation.h"
#include "compiler/gltf_scene.h"
#include "compiler/gltf_skin.h"

#include <map>
#include <vector>

/// What the animations of a file can move, by its nodes.
struct MovingNodes
{
    std::vector<bool> places;  // [node] its place or visibility, or one of its ancestors'
    std::vector<bool> morphs;  // [node] its morph weights
    std::vector<bool> appears; // [node] its own visibility

    MovingNodes(const tinygltf::Model& model, const std::vector<Animation>& animations);
};

/// Where an object that moves finds what moves it in the tables.
struct MovingPlace
{
    uint32_t node = 0;       // of the tables
    uint32_t node_bone = 0;  // the bone that its node is
    uint32_t first_bone = 0; // of its joints, where it has a skin
    uint32_t first_weight = 0;
    bool hidden = false; // at rest
};

/// Collects nodes, bones and channels. Nodes that nothing refers to are left out.
class MotionBuilder
{
public:
    MotionBuilder(const tinygltf::Model& model, const std::vector<Animation>& animations);

    /// @param pose of the joints that place it; null without a skin
    MovingPlace addObject(const MeshInstance& instance, const SkinPose* pose);
    void addLight(uint32_t number, size_t node, const tinygltf::Light& light);
    void addCamera(uint32_t number, size_t node);

    /// The tables without objects; null where they are empty.
    /// @param material_of [material of the file] its number in the package, -1: it is not used
    std::shared_ptr<MotionData> finish(const std::vector<int>& material_of);

private:
    uint32_t node(size_t of_file);
    void addChannels(const Animation& animation, const std::vector<int>& material_of, lumicut::fb::ClipT& clip);
    void addEmission(size_t of_file, uint32_t material);
    /// The numbers in the tables of an item of the file.
    std::vector<uint32_t> itemsOf(const AnimationTrack& track, const std::vector<int>& material_of) const;

    const tinygltf::Model& model_;
    const std::vector<Animation>& animations_;
    std::vector<int> parents_;                         // [node], -1: none
    std::map<size_t, uint32_t> nodes_;                 // by the file's number
    std::multimap<size_t, uint32_t> lights_, cameras_; // likewise
    std::shared_ptr<MotionData> motion_ = std::make_shared<MotionData>();
};
