// Stages of global illumination on their own: what they need on the GPU, and what they made of it back here.
#pragma once
#include "runtime/stages/cut.h"
#include "tests/stages/double3.h"
#include "tests/stages/gpu_test.h"
#include "tests/stages/scene_builder.h"

#include <functional>
#include <optional>
#include <span>

/// Where p lies in the grid of lib/morton.glsl, 0 to 1, while no picture was drawn: the view scale is that of the whole scene.
Double3 gridPlace(const gpu::SceneInfo& info, Double3 p);
/// Its inverse.
Double3 fromGridPlace(const gpu::SceneInfo& info, Double3 place);

/// A cut node's normal, and the other way round; packed without an eye, so that its disc is seen from infinitely far.
Double3 unpackedCutNormal(const gpu::CutNode& node);
uint32_t packedCutNormal(Double3 normal);

/// A tree as it lies on the GPU.
struct TreeData
{
    std::vector<gpu::TreeNode> nodes;                        // [count - 1]
    std::vector<uint32_t> order, leaf_parents, node_parents; // [count], [count], [count - 1]
};

/// A photon map: the stage that made it, and its contents.
struct PhotonMap
{
    PhotonMap(const Device& device, const SceneGpu& scene, uint32_t max_photons)
        : rays(device, scene), stage(device, "test.map", max_photons)
    {
    }

    RayStage rays;
    PhotonTreeStage stage;
    std::optional<PhotonTreeStage::Output> gpu;
    std::vector<gpu::Photon> photons; // sorted as the tree
    TreeData tree;
};

/// Stored photons made by hand: paths of equal length, one after another.
struct Paths
{
    Buffer photons, slots, size, offsets, counts, store;
    uint32_t path_count;
    StoredPhotons output() const
    {
        return {.photons = photons,
                .slots = slots,
                .size = size,
                .offsets = offsets,
                .counts = counts,
                .store = store,
                .path_count = path_count,
                .capacity = path_count};
    }
};

/// A cut made by hand.
struct Cut
{
    std::optional<Tree> tree;
    Buffer size, nodes, directions;
    std::optional<CutStage::Output> gpu;
    std::vector<gpu::CutNode> sorted; // as the tree
};

/// What density estimation may give: the kernel finds the distance of the k-th photon by a histogram, to one of its
/// bins.
struct DensityBounds
{
    Double3 least, most; // W/m^2
    double exact;        // luminance of the estimate over the exact distance of the k-th photon
};

class GiTest : public GpuTest
{
protected:
    /// Runs what `record` records, and waits.
    static void submit(const SceneGpu& scene, const std::function<void(Recorder&)>& record);

    /// The first `count` elements of a buffer, which may be none.
    template <typename T>
    static std::vector<T> contents(const Buffer& buffer, uint32_t count)
    {
        return count > 0 ? device().download<T>(buffer, count) : std::vector<T>();
    }
    static TreeData contents(const Tree& tree, uint32_t count);
    static uint32_t countOf(const Buffer& size) { return device().download<gpu::QueueSize>(size, 1)[0].count; }
    /// A count, ready for dispatch.
    static Buffer sizeBuffer(uint32_t count);
    template <typename T>
    static Buffer upload(std::string_view name, std::vector<T> data)
    {
        if (data.empty())
            data.resize(1);
        return device().upload<T>(name, std::span<const T>(data));
    }

    /// The map of exactly these photons.
    static std::unique_ptr<PhotonMap> mapOf(const SceneGpu& scene, const std::vector<gpu::Photon>& photons);
    /// These photons, of which every `length` are a path.
    static Paths pathsOf(const std::vector<gpu::Photon>& photons, uint32_t length);
    /// The cut of exactly these nodes.
    /// @param direction in which light arrives at a node; without it, straight down on its surface
    static std::unique_ptr<Cut> cutOf(const SceneGpu& scene, const std::vector<gpu::CutNode>& nodes,
                                      const std::function<Double3(const gpu::CutNode&)>& direction = {});
    /// The photons that a stage has stored.
    static std::vector<gpu::Photon> stored(const PhotonStage::Output& out);
    /// The photons that a global or caustic emission stores.
    /// @param capacity of the store, in photons; without it there is room for 32 a path
    static std::vector<gpu::Photon> emit(const SceneGpu& scene, PhotonKind kind, const PhotonStage::Input& in,
                                         std::optional<uint32_t> capacity = {});

    /// Renders with exactly `settings`, and expects every sample to be finite.
    Picture renderGi(const SceneGpu& scene, const Camera& camera, const Settings& settings, uint32_t frame_count,
                     uint32_t width, uint32_t height, uint32_t seed = 0);

    static double diagonalOf(const SceneGpu& scene);
};

/// Density estimation by brute force over all photons.
/// @param wanted k, @param radius metres at most
DensityBounds densityBounds(std::span<const gpu::Photon> photons, Double3 x, Double3 n, uint32_t wanted, double radius);

/// A material of smooth metal.
nlohmann::json mirror(double r, double g, double b);
/// Few photons, samples and rays, for small pictures.
Settings smallSettings();
