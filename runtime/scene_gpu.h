// A package's scene on the device: descriptor set 0 of every kernel.
#pragma once
#include "format/package_read.h"
#include "runtime/frame/light_range.h"
#include "runtime/gpu/gpu.h"

#include <array>
#include <memory>
#include <vector>

struct LightProbability // of the scene's power
{
    uint32_t kind; // gpu::kLight*
    float pmf;

    /// Directional or environment: its power does not tell how much of it is visible. Otherwise it is a local light.
    bool isInfinite() const { return kind == gpu::kLightDirectional || kind == gpu::kLightEnvironment; }
    bool isPunctual() const { return kind < gpu::kLightTriangle; }
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
    /// Whether it has any of these kFeature*.
    bool hasFeature(uint32_t features) const { return (features_ & features) != 0; }
    /// Some opaque material is so rough that spherical harmonics can replace rays (shaders/gather/harmonics.h).
    bool reflectsRoughly() const { return reflects_roughly_; }
    /// Some material is a mirror over something else: glass, or a smooth layer. What textures say of it is left out.
    bool hasSmoothLayers() const { return has_smooth_layers_; }
    /// Replaces light `index` from the next kernel of `rec` on; with the kind and pmf it has, on which other tables rest.
    void setLight(Recorder& rec, uint32_t index, const gpu::Light& light);
    /// Replaces what material `index` emits, W/(m^2 sr) before its texture, from the next kernel of `rec` on. Of a surface
    /// whose triangles are lights those are to be replaced too.
    void setEmission(Recorder& rec, uint32_t index, gpu::vec3 emission);
    /// gpu::ViewScale, which every kernel can read: of the whole scene until a ViewScaleStage sets it.
    const Buffer& viewScale() const { return buffers_.back(); }
    /// Grows whenever a light or an emission is replaced: what was made under another version is out of date.
    uint64_t lightsVersion() const { return lights_version_; }
    /// As they were set last.
    const Emitters& emitters() const { return emitters_; }
    /// By light index.
    std::span<const LightProbability> lightProbabilities() const { return light_probabilities_; }
    /// Some light has an extent, so that a ray may find it: an emissive triangle or an environment.
    bool hasAreaLights() const { return hasFeature(gpu::kFeatureTriangleLights | gpu::kFeatureEnvironment); }

private:
    explicit SceneGpu(const Device& device) : device_(device) {}
    void createImages(const package::Package& package);
    void createDescriptorSet();

    const Device& device_;
    gpu::SceneInfo info_{};
    std::vector<LightProbability> light_probabilities_;
    Emitters emitters_;
    uint64_t lights_version_ = 0;
    uint32_t features_ = 0; // kFeature*
    std::array<Constant, 2> constants_{};
    bool reflects_roughly_ = false;
    bool has_smooth_layers_ = false;
    Buffer info_buffer_;
    std::vector<Buffer> buffers_;      // by binding, kBvhNodesBinding first
    std::vector<const Buffer*> bound_; // by binding
    std::vector<Image>
        pages_; // the package's, then a white one of 1 x 1 for those that are missing to kTexturePageCount
    Image environment_;
    VkSampler texture_sampler_ = VK_NULL_HANDLE, environment_sampler_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};
