// A package's scene on the device: descriptor set 0 of every kernel.
#pragma once
#include "format/package_read.h"
#include "runtime/frame/light_range.h"
#include "runtime/gpu/gpu.h"
#include "runtime/scene_lights.h"

#include <array>
#include <memory>
#include <vector>

/// Each grows when something of the scene changes: what was made under another version is out of date.
struct SceneVersion
{
    uint64_t geometry = 0;
    uint64_t lights = 0;    // what lights and materials emit
    uint64_t materials = 0; // what else materials are
    bool operator==(const SceneVersion&) const = default;
};

class SceneGpu
{
public:
    /// Uploads everything kernels read. The package may be closed afterwards.
    /// @return kDevice where a chunk is larger than the device's storage buffers may be
    static Result<std::unique_ptr<SceneGpu>> create(const Device& device, const package::Package& package);
    ~SceneGpu();
    SceneGpu(const SceneGpu&) = delete;
    SceneGpu& operator=(const SceneGpu&) = delete;

    SceneSet descriptorSet() const { return {.set = set_, .buffers = bound_}; }
    const gpu::SceneInfo& info() const { return info_; }
    /// Specialization constants of every kernel that reads the scene: features, texture pages in use (lib/scene.glsl).
    SharedConstants constants() const { return SharedConstants(constants_); }
    /// The same for kernels that follow light from surface to surface, not from the eye: without delta lobes where the scene has
    /// too few for that (sendsCaustics()).
    SharedConstants transportConstants() const { return SharedConstants(transport_constants_); }
    /// Mirrors, glass or smooth layers send so much light that it matters to other surfaces.
    bool sendsCaustics() const { return sends_caustics_; }
    /// Whether it has any of these kFeature*.
    bool hasFeature(uint32_t features) const { return (features_ & features) != 0; }
    /// Some opaque material is so rough that spherical harmonics can replace rays (shaders/gather/harmonics.h).
    bool reflectsRoughly() const { return reflects_roughly_; }
    /// Some material is a mirror over something else: glass, or a smooth layer. What textures say of it is left out.
    bool hasSmoothLayers() const { return has_smooth_layers_; }
    /// Changes lights, their place, direction, colour, power, whether they are there at all, and by what probability they are
    /// picked, from the next kernel of `rec` on. Cheaper for all at once than one by one. @param changed each of another light
    void setLights(Recorder& rec, std::span<const ChangedLight> changed);
    void setLight(Recorder& rec, uint32_t index, const gpu::Light& light);
    /// Replaces what material `index` emits, W/(m^2 sr) before its texture, from the next kernel of `rec` on. Of a surface
    /// whose triangles are lights those are to be replaced too.
    void setEmission(Recorder& rec, uint32_t index, gpu::vec3 emission);
    /// gpu::ViewScale, which every kernel can read: of the whole scene until a ViewScaleStage sets it.
    const Buffer& viewScale() const { return buffers_.back(); }
    /// Replaces material `index`, with the textures and flags it has, from the next kernel of `rec` on.
    void setMaterial(Recorder& rec, uint32_t index, const gpu::Material& material);
    /// Geometry has been moved: vertices, triangles and boxes in the buffers of the scene.
    void noteMove() { ++version_.geometry; }
    SceneVersion version() const { return version_; }
    /// A buffer of descriptor set 0, by its binding.
    const Buffer& buffer(uint32_t binding) const { return *bound_[binding]; }
    /// Where moving triangles were in the frame before, gpu::TriangleCorners[] from info().first_moving_slot on.
    const Buffer& lastCorners() const { return last_corners_; }
    /// Some of its geometry can move.
    bool canMove() const { return info_.first_moving_slot != gpu::kNone; }
    /// As they were set last.
    Emitters emitters() const;
    /// By index, as they were set last, with the probabilities by which they are picked now.
    std::span<const gpu::Light> lights() const { return lights_->lights(); }
    /// Grows when those probabilities change: tables made of them are out of date.
    uint64_t lightTableVersion() const { return lights_->tableVersion(); }
    /// Some light has an extent, so that a ray may find it: an emissive triangle or an environment.
    bool hasAreaLights() const { return hasFeature(gpu::kFeatureTriangleLights | gpu::kFeatureEnvironment); }

private:
    explicit SceneGpu(const Device& device) : device_(device) {}
    void createImages(const package::Package& package);
    void createDescriptorSet();

    const Device& device_;
    gpu::SceneInfo info_{};
    std::optional<SceneLights> lights_;
    std::vector<gpu::vec3> emissions_; // by material
    SceneVersion version_;
    uint32_t features_ = 0; // kFeature*
    std::array<Constant, 2> constants_{}, transport_constants_{};
    bool sends_caustics_ = false;
    bool reflects_roughly_ = false;
    bool has_smooth_layers_ = false;
    Buffer info_buffer_;
    Buffer last_corners_;
    std::vector<Buffer> buffers_;      // by binding, kBvhNodesBinding first
    std::vector<const Buffer*> bound_; // by binding
    std::vector<Image>
        pages_; // the package's, then a white one of 1 x 1 for those that are missing to kTexturePageCount
    Image environment_;
    VkSampler texture_sampler_ = VK_NULL_HANDLE, environment_sampler_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};
