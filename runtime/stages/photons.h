// Photons: emission from every light and their paths through the scene.
#pragma once
#include "runtime/stages/guide.h"
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
    /// @param max_paths photons emitted a frame at most, @param max_bounces photons one path may store at most
    PhotonStage(const Device& device, const SceneGpu& scene, PhotonKind kind, uint32_t max_paths, uint32_t max_bounces);

    struct Input
    {
        uint32_t path_count;     // photons to emit, <= max_paths
        uint32_t bounce_limit;   // photons a path may store, <= max_bounces
        uint32_t specular_depth; // delta events a path may have besides
        uint32_t first_path;     // index of path 0 in the sequence of all frames
        uint32_t seed;
        const GuideStage* guide = nullptr; // says how photons leave; of Kind::kGlobal only
        bool operator==(const Input&) const = default; // equal input under equal lights gives equal photons
    };
    struct Output
    {
        const Buffer& photons; // gpu::Photon[slot_count], only where flags says so
        const Buffer& flags;   // uint[slot_count]: 1 where a photon is stored
        uint32_t slot_count;   // path_count x bounce_limit
    };
    Output record(Recorder& rec, const RayStage& rays, const Input& in) const;

private:
    PhotonKind kind_;
    bool has_specular_, has_targets_;
    Kernel emit_, trace_;
    Buffer starts_, photons_, flags_, traced_;
};
