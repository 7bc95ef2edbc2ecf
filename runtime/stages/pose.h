// Brings a scene's moving geometry to a pose: deforms it, refits its part of the hierarchy, and moves what follows it.
#pragma once
#include "format/pose.h"
#include "runtime/object_bounds.h"
#include "runtime/object_tree.h"
#include "runtime/scene_gpu.h"
#include "runtime/stages/emitter_shapes.h"
#include "shaders/pose/pose.h"

class PoseStage
{
public:
    /// One for a scene: its hierarchy is taken for that of the package.
    /// @param package that `scene` was made of; it has motion
    /// @param drift   as ObjectTree takes it: when objects are hung anew; infinity: never
    PoseStage(const Device& device, SceneGpu& scene, const package::Package& package,
              double drift = ObjectTree::kDrift);

    /// Vertices, normals, boxes, emissive triangles, caustic targets and bounds become those of the pose, and so do lights and
    /// materials, and how often lights are picked, from the next kernel of `rec` on. What triangles showed before is kept as SceneGpu::lastCorners(). Records
    /// nothing where all this is so already.
    void record(Recorder& rec, const package::Pose& pose);

private:
    void uploadBones(Recorder& rec, const package::Pose& pose);
    /// Triangles whose sides a scale below 0 exchanges. Comes before refit().
    void wind(Recorder& rec) const;
    /// Where they have travelled so far that rays would be slow. Boxes are wrong until refit().
    void hangObjects(Recorder& rec, const package::Pose& pose);
    void refit(Recorder& rec) const;
    void changeLights(const package::Pose& pose);
    void setMaterials(Recorder& rec, const package::Pose& pose);
    void setMaterial(Recorder& rec, uint32_t index, const gpu::Material& before, const gpu::Material& now);

    SceneGpu& scene_;
    ObjectBounds bounds_;
    ObjectTree tree_;
    Kernel deform_, refit_, follow_;
    std::optional<Kernel> hang_;            // where tree_ can change
    std::optional<Kernel> wind_;            // where scales can change their sign
    Buffer vertices_, influences_, morphs_; // gpu::MovingVertex[count + 1], gpu::Influence[], gpu::MorphOffset[]
    Buffer bones_, weights_;                // gpu::BoneMatrix[], float[]
    Buffer positions_;                      // vec3[vertex_count]
    Buffer leaves_, parents_, arrivals_;    // gpu::PosedLeaf[], uint[moving nodes] twice
    Buffer mirrored_;                       // uint[moving slots]
    Buffer objects_;                        // gpu::PosedObject[]
    Buffer emitters_, targets_;             // gpu::PosedEmitter[], gpu::PosedTarget[]
    gpu::PoseParams params_{};
    std::optional<package::Pose> last_;
    bool moved_ = false;                             // in the last record()
    std::vector<gpu::Material> rest_;                // the package's
    std::vector<std::vector<uint32_t>> emitters_of_; // by material: lights that are triangles of it
    EmitterShapes shapes_;
    LightChanges changes_; // of the record() at hand
};
