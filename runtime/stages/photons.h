// Photons: emission from every light and their paths through the scene.
#pragma once
#include "runtime/stages/guide.h"
#include "runtime/stages/primitives.h"
#include "shaders/photons/photons.h"

/// Which photons a map holds (path ownership: each light path is in one of them where it is read).
enum class PhotonKind
{
    kGlobal,  // one at every surface that scatters; read through the illumination cut, at gather hits only
    kCaustic, // L S+ D alone, aimed at specular objects; read directly, at shading points only
};

class PhotonStage
{
public:
    /// @param max_paths photons emitted a frame at most
    /// @param capacity photons that a map holds at most: where paths store more, the last paths are left out and the others
    ///        carry their light
    PhotonStage(const Device& device, const SceneGpu& scene, PhotonKind kind, uint32_t max_paths, uint32_t capacity,
                const Scratch& scratch = {});

    static uint64_t scratchBytes(uint32_t max_paths, uint32_t capacity);

    struct Input
    {
        uint32_t path_count; // photons to emit, <= max_paths
        uint32_t first_path; // index of path 0 in the sequence of all frames
        uint32_t seed;
        const GuideStage* guide = nullptr; // the emission distribution; of PhotonKind::kGlobal only
        uint32_t bounce_limit =
            gpu::kNone; // photons that a path may store; a limit loses power: for tests of the first bounces
        bool operator==(const Input&) const = default; // equal input under equal lights gives equal photons
    };
    using Output = StoredPhotons; // in scratch memory
    Output record(Recorder& rec, const RayStage& rays, const Input& in) const;
    /// What the last record() left. @param path_count of its input
    Output output(uint32_t path_count) const;
    /// gpu::PhotonStore of the last record().
    const Buffer& store() const { return store_; }

private:
    PhotonKind kind_;
    bool has_targets_;
    uint32_t capacity_;
    Kernel emit_, trace_, close_, place_;
    Scan scan_;
    Buffer starts_, photons_, tags_, appended_, counts_, offsets_, total_, store_, slots_, size_, path_size_, in_order_,
        again_, traced_;
};
