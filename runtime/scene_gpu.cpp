#include "runtime/scene_gpu.h"

#include "format/material.h"
#include "runtime/texture_pages.h"
#include "shaders/gather/harmonics.h"
#include "shaders/pose/pose.h"
#include "shaders/view_scale/view_scale.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace
{
constexpr uint32_t kWhite = 0x3c003c00; // two halfs of 1

gpu::vec3 toVec3(const lumicut::fb::Vec3& v)
{
    return {v.x(), v.y(), v.z()};
}

bool hasMovingTriangles(const package::Package& package)
{
    return package.firstMovingSlot() < package.bvhTriangles().size();
}

gpu::SceneInfo sceneInfo(const package::Package& package)
{
    const auto& meta = package.meta();
    const auto lights = package.lights();
    gpu::SceneInfo info{
        .bounds_min = toVec3(*meta.bounds_min()),
        .light_count = uint32_t(lights.size()),
        .bounds_max = toVec3(*meta.bounds_max()),
        .environment_light = gpu::kNone,
        .environment_importance_size = {},
        .caustic_target_count = uint32_t(package.causticTargets().size()),
        .triangle_count = uint32_t(package.triangles().size()),
        .environment_turn = 0,
        .first_moving_slot = hasMovingTriangles(package) ? package.firstMovingSlot() : gpu::kNone,
    };
    if (!lights.empty() && lights.back().kind == gpu::kLightEnvironment)
    {
        info.environment_light = uint32_t(lights.size() - 1);
        info.environment_importance_size = {meta.environment()->importance_width(),
                                            meta.environment()->importance_height()};
        info.environment_turn = meta.environment()->rotation() * float(0.5 / std::numbers::pi);
    }
    return info;
}

uint32_t materialFeatures(const gpu::Material& material)
{
    const gpu::vec3& sheen = material.sheen_color;
    const bool has_sheen = sheen.x > 0 || sheen.y > 0 || sheen.z > 0;
    const bool dielectric_reflects = material.specular > 0 && material.metallic < 1;
    const bool is_specular = dielectric_reflects || material.metallic > 0 || material.transmission > 0 ||
                             material.clearcoat > 0 || has_sheen || material.diffuse_transmission > 0;
    uint32_t features = (material.transmission > 0 ? gpu::kFeatureTransmission : 0u) |
                        (material.metallic > 0 ? gpu::kFeatureMetal : 0u) | (is_specular ? gpu::kFeatureSpecular : 0u) |
                        (material.clearcoat > 0 ? gpu::kFeatureClearcoat : 0u) | (has_sheen ? gpu::kFeatureSheen : 0u) |
                        (material.anisotropy > 0 ? gpu::kFeatureAnisotropy : 0u) |
                        (material.iridescence > 0 ? gpu::kFeatureIridescence : 0u) |
                        (material.dispersion > 0 && material.transmission > 0 ? gpu::kFeatureDispersion : 0u) |
                        (material.diffuse_transmission > 0 ? gpu::kFeatureDiffuseTransmission : 0u);
    for (const package::MaterialTexture& texture : package::kMaterialTextures)
        if (material.*texture.index != gpu::kNone) // every map of normals wants tangents, the coat's too
            features |= texture.feature | (texture.encoding == gpu::kEncodingNormal ? gpu::kFeatureNormalMaps : 0u);
    return features;
}

/// Whether some animation sets such a property.
bool isAnimated(const package::Package& package, lumicut::fb::ChannelTarget target)
{
    if (package.motion() == nullptr)
        return false;
    return std::ranges::any_of(*package.motion()->clips(),
                               [&](const auto* clip) {
                                   return std::ranges::any_of(*clip->channels(), [&](const auto* channel)
                                                              { return channel->target() == target; });
                               });
}

uint32_t sceneFeatures(const package::Package& package)
{
    uint32_t features =
        (package.meta().has_alpha() ? gpu::kFeatureAlpha : 0u) | (package.meta().has_thin() ? gpu::kFeatureThin : 0u);
    for (const gpu::Material& material : package.materials())
        features |= materialFeatures(material);
    if (isAnimated(package, lumicut::fb::ChannelTarget::MaterialMetallic))
        features |= gpu::kFeatureMetal | gpu::kFeatureSpecular;
    const bool any_roughness = isAnimated(package, lumicut::fb::ChannelTarget::MaterialRoughness);
    if ((features & gpu::kFeatureSpecular) != 0 && (any_roughness || package.meta().has_delta_lobes()))
        features |= gpu::kFeatureDeltaLobes;
    if (std::ranges::any_of(package.textureRefs(),
                            [](const gpu::TextureRef& ref) { return (ref.sampling & gpu::kSampleUv1) != 0; }))
        features |= gpu::kFeatureSecondUv;
    if (std::ranges::any_of(*package.meta().texture_pages(), [](const auto* page) { return page->tiled(); }))
        features |= gpu::kFeatureTiles;
    if (std::ranges::any_of(package.vertexAttributes(),
                            [](const gpu::VertexAttributes& v) { return v.color.x != kWhite || v.color.y != kWhite; }))
        features |= gpu::kFeatureVertexColors;
    for (const gpu::Light& light : package.lights())
        features |= light.kind == gpu::kLightEnvironment ? gpu::kFeatureEnvironment
                    : light.kind >= gpu::kLightTriangle  ? gpu::kFeatureTriangleLights
                                                         : gpu::kFeaturePunctualLights;
    return features;
}
/// Of the moving triangles as they are at rest; one at least.
std::vector<gpu::TriangleCorners> movingCorners(const package::Package& package)
{
    std::vector<gpu::TriangleCorners> corners;
    if (hasMovingTriangles(package))
        for (const gpu::BvhTriangle& t : package.bvhTriangles().subspan(package.firstMovingSlot()))
            corners.push_back({t.v0, t.v1, t.v2});
    corners.resize(std::max<size_t>(corners.size(), 1));
    return corners;
}

gpu::ViewScale wholeScene(const gpu::SceneInfo& info)
{
    const gpu::vec3 low = info.bounds_min, high = info.bounds_max;
    return {.focus = {0.5f * (low.x + high.x), 0.5f * (low.y + high.y), 0.5f * (low.z + high.z)},
            .distance = std::hypot(high.x - low.x, high.y - low.y, high.z - low.z)};
}

bool isRough(const gpu::Material& material)
{
    return material.roughness > gpu::kHarmonicsFrom && (material.specular > 0 || material.metallic > 0);
}

bool hasSmoothLayer(const gpu::Material& material)
{
    const bool smooth = material.roughness < gpu::kSmoothRoughness && material.metallic < 1 && material.specular > 0;
    return smooth || (material.clearcoat > 0 && material.clearcoat_roughness < gpu::kSmoothRoughness);
}
} // namespace

Result<std::unique_ptr<SceneGpu>> SceneGpu::create(const Device& device, const package::Package& package)
{
    std::unique_ptr<SceneGpu> scene(new SceneGpu(device));
    scene->lights_.emplace(device, package);
    for (const gpu::Material& material : package.materials())
        scene->emissions_.push_back(material.emission);
    std::optional<Error> too_large;
    const auto fits = [&](const char* name, auto data, uint64_t limit)
    {
        if (data.size_bytes() > limit)
            too_large = Error{ExitCode::kDevice,
                              fmt::format("the scene's {} take {} MiB, more than the {} MiB that a buffer may "
                                          "have on {}; try another device or a smaller scene",
                                          name, data.size_bytes() >> 20, limit >> 20, device.name())};
        return data.size_bytes() <= limit;
    };
    const auto addTexels = [&](const char* name, auto data)
    {
        const bool fit = fits(name, data, uint64_t(device.limits().maxTexelBufferElements) * kTexelBytes);
        scene->buffers_.push_back(fit ? device.uploadTexels(fmt::format("scene.{}", name), data) : Buffer());
    };
    const auto add = [&](const char* name, auto data)
    {
        const bool fit = fits(name, data, device.limits().maxStorageBufferRange);
        scene->buffers_.push_back(fit ? device.upload(fmt::format("scene.{}", name), data) : Buffer());
    };
    addTexels("BVH nodes", package.bvhNodes()); // in the order of the bindings in gpu_scene.h
    addTexels("BVH triangles", package.bvhTriangles());
    addTexels("triangles", package.triangles());
    addTexels("vertices", package.vertexAttributes());
    addTexels("materials", package.materials());
    addTexels("lights", package.lights());
    add("texture references", package.textureRefs());
    add("light aliases", package.lightAliases());
    add("environment texels", package.environmentTexels());
    add("caustic targets", package.causticTargets());
    if (too_large)
        return *too_large;
    scene->info_ = sceneInfo(package);
    const gpu::ViewScale whole = wholeScene(scene->info_); // until a picture is drawn
    scene->buffers_.push_back(device.upload("scene.view_scale", std::span(&whole, 1)));
    scene->info_buffer_ = device.upload("scene.info", std::span<const gpu::SceneInfo>(&scene->info_, 1));
    const std::vector<gpu::TriangleCorners> corners = movingCorners(package);
    scene->last_corners_ = device.upload<gpu::TriangleCorners>("scene.last_corners", corners);
    scene->features_ = sceneFeatures(package);
    const bool any_roughness = isAnimated(package, lumicut::fb::ChannelTarget::MaterialRoughness);
    scene->sends_caustics_ =
        scene->hasFeature(gpu::kFeatureDeltaLobes) && (any_roughness || package.meta().has_caustics());
    const Constant pages{"kUsedTexturePages", package.meta().texture_pages()->size()};
    scene->constants_ = {Constant{"kSceneFeatures", scene->features_}, pages};
    scene->transport_constants_ = scene->constants_;
    if (!scene->sends_caustics_)
        scene->transport_constants_[0].value &= ~gpu::kFeatureDeltaLobes;
    scene->reflects_roughly_ = any_roughness || std::ranges::any_of(package.materials(), isRough);
    scene->has_smooth_layers_ = any_roughness || std::ranges::any_of(package.materials(), hasSmoothLayer);
    scene->createImages(package);
    scene->createDescriptorSet();
    return scene;
}

SceneGpu::~SceneGpu()
{
    device_.waitIdle();
    vkDestroyDescriptorPool(device_.handle(), pool_, nullptr);
    vkDestroySampler(device_.handle(), texture_sampler_, nullptr);
    vkDestroySampler(device_.handle(), environment_sampler_, nullptr);
}

void SceneGpu::setLights(Recorder& rec, std::span<const ChangedLight> changed)
{
    if (changed.empty())
        return;
    ++version_.lights;
    lights_->set(rec, changed, buffer(gpu::kLightsBinding), buffer(gpu::kLightAliasesBinding));
}

void SceneGpu::setLight(Recorder& rec, uint32_t index, const gpu::Light& light)
{
    const ChangedLight changed{index, light};
    setLights(rec, std::span(&changed, 1));
}

Emitters SceneGpu::emitters() const
{
    return {.lights = {lights().begin(), lights().end()}, .emissions = emissions_};
}

void SceneGpu::setEmission(Recorder& rec, uint32_t index, gpu::vec3 emission)
{
    const Buffer& materials = buffers_[gpu::kMaterialsBinding - gpu::kBvhNodesBinding];
    check((index + 1) * sizeof(gpu::Material) <= materials.size(), "material {} of {} bytes of them", index,
          materials.size());
    ++version_.lights;
    emissions_[index] = emission;
    rec.write(materials, index * sizeof(gpu::Material) + offsetof(gpu::Material, emission),
              std::as_bytes(std::span(&emission, 1)));
}

void SceneGpu::setMaterial(Recorder& rec, uint32_t index, const gpu::Material& material)
{
    const Buffer& materials = buffer(gpu::kMaterialsBinding);
    check((index + 1) * sizeof(material) <= materials.size(), "material {} of {} bytes of them", index,
          materials.size());
    ++version_.materials;
    emissions_[index] = material.emission;
    rec.write(materials, index * sizeof(material), std::as_bytes(std::span(&material, 1)));
}

void SceneGpu::createImages(const package::Package& package)
{
    constexpr std::array<uint32_t, 4> kWhiteTexel{~0u, ~0u, ~0u, ~0u};
    for (uint32_t p = 0; p < package.meta().texture_pages()->size(); ++p)
        pages_.push_back(uploadTexturePage(device_, package, p));
    if (pages_.size() < gpu::kTexturePageCount) // one for all that are not there
        pages_.push_back(
            device_.uploadImage("scene.no_page", {.array = true}, std::as_bytes(std::span(kWhiteTexel).first(1))));
    if (const auto* environment = package.meta().environment())
        environment_ = device_.uploadImage(
            "scene.environment",
            {.format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = environment->width(), .height = environment->height()},
            std::as_bytes(package.environmentMap()));
    else
        environment_ = device_.uploadImage("scene.no_environment", {.format = VK_FORMAT_R32G32B32A32_SFLOAT},
                                           std::as_bytes(std::span(kWhiteTexel)));
}

void SceneGpu::createDescriptorSet()
{
    VkSamplerCreateInfo sampler{
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .magFilter = VK_FILTER_LINEAR,
        .minFilter = VK_FILTER_LINEAR,
        .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
        .addressModeU = VK_SAMPLER_ADDRESS_MODE_REPEAT,
        .addressModeV = VK_SAMPLER_ADDRESS_MODE_REPEAT,
        .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .maxLod = VK_LOD_CLAMP_NONE,
    };
    vulkanCheck(vkCreateSampler(device_.handle(), &sampler, nullptr, &texture_sampler_));
    sampler.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    vulkanCheck(vkCreateSampler(device_.handle(), &sampler, nullptr, &environment_sampler_));

    constexpr uint32_t kTexelBufferCount = gpu::kLightsBinding - gpu::kBvhNodesBinding + 1;
    const uint32_t storage_count = uint32_t(buffers_.size()) - kTexelBufferCount;
    const std::array sizes{
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, kTexelBufferCount},
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, storage_count},
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, gpu::kTexturePageCount + 1},
    };
    const VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .maxSets = 1,
                                          .poolSizeCount = uint32_t(sizes.size()),
                                          .pPoolSizes = sizes.data()};
    vulkanCheck(vkCreateDescriptorPool(device_.handle(), &pool, nullptr, &pool_));
    const VkDescriptorSetLayout layout = device_.sceneSetLayout();
    const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .descriptorPool = pool_,
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &layout};
    vulkanCheck(vkAllocateDescriptorSets(device_.handle(), &allocate, &set_));

    static_assert(gpu::kSceneInfoBinding == 0 && gpu::kBvhNodesBinding == 1);
    bound_ = {&info_buffer_};
    for (const Buffer& buffer : buffers_)
        bound_.push_back(&buffer);
    std::vector<VkDescriptorBufferInfo> buffers;
    for (const Buffer* buffer : bound_)
        buffers.push_back({buffer->handle(), 0, VK_WHOLE_SIZE});
    std::vector<VkDescriptorImageInfo> images;
    for (size_t p = 0; p < gpu::kTexturePageCount; ++p)
        images.push_back({texture_sampler_, pages_[std::min(p, pages_.size() - 1)].view(),
                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    images.push_back({environment_sampler_, environment_.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});

    std::vector<VkWriteDescriptorSet> writes;
    const auto write = [&](uint32_t binding, VkDescriptorType type, uint32_t count,
                           const VkDescriptorBufferInfo* buffer, const VkDescriptorImageInfo* image)
    {
        writes.push_back({.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                          .dstSet = set_,
                          .dstBinding = binding,
                          .descriptorCount = count,
                          .descriptorType = type,
                          .pImageInfo = image,
                          .pBufferInfo = buffer});
    };
    write(gpu::kSceneInfoBinding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, &buffers[0], nullptr);
    for (uint32_t b = 0; b < kTexelBufferCount; ++b)
    {
        write(gpu::kBvhNodesBinding + b, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 1, nullptr, nullptr);
        writes.back().pTexelBufferView = &buffers_[b].texels();
    }
    for (uint32_t b = kTexelBufferCount; b < buffers_.size(); ++b)
        write(gpu::kBvhNodesBinding + b, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, &buffers[b + 1], nullptr);
    write(gpu::kTexturePagesBinding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, gpu::kTexturePageCount, nullptr,
          images.data());
    write(gpu::kEnvironmentMapBinding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, nullptr, &images.back());
    vkUpdateDescriptorSets(device_.handle(), uint32_t(writes.size()), writes.data(), 0, nullptr);
}
