#include "runtime/capture.h"

#include "image/write_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>

Status checkPicturePath(const std::filesystem::path& path)
{
    if (path.extension() == ".exr" || path.extension() == ".png")
        return Success{};
    return Error{ExitCode::kUsage, "pictures are written as .exr or .png", path.string()};
}

namespace
{
std::vector<uint8_t> displayed(Renderer& renderer, const Device& device, const SceneGpu& scene,
                               const Settings& settings)
{
    Recorder rec(device);
    rec.begin(scene.descriptorSet());
    const Buffer& pixels = renderer.display(rec, settings, false);
    rec.submitAndWait();
    const std::vector<uint32_t> rgba =
        device.download<uint32_t>(pixels, uint64_t(renderer.width()) * renderer.height());
    std::vector<uint8_t> rgb;
    rgb.reserve(rgba.size() * 3);
    for (const uint32_t pixel : rgba)
        for (const uint32_t shift : {0u, 8u, 16u})
            rgb.push_back(uint8_t(pixel >> shift));
    return rgb;
}

using Layer = Capture::Layer;

Layer pictureOf(const Renderer& renderer, const Device& device)
{
    const std::vector<gpu::vec3> pixels = renderer.picture(device);
    Layer layer{.name = "", .channels = "RGB", .values = std::vector<float>(3 * pixels.size())};
    static_assert(sizeof(gpu::vec3) == 3 * sizeof(float));
    std::memcpy(layer.values.data(), pixels.data(), pixels.size() * sizeof(gpu::vec3));
    return layer;
}

/// A member of LayerSums as the mean over `count` frames.
Layer meanOf(std::span<const gpu::LayerSums> sums, uint32_t count, const std::string& name,
             gpu::vec3 gpu::LayerSums::*member)
{
    Layer layer{.name = name, .channels = "RGB", .values = {}};
    for (const gpu::LayerSums& pixel : sums)
    {
        const gpu::vec3 mean = 1 / float(count) * (pixel.*member);
        layer.values.insert(layer.values.end(), {mean.x, mean.y, mean.z});
    }
    return layer;
}

Layer normalsOf(std::span<const gpu::LayerSums> sums)
{
    Layer layer{.name = "normal", .channels = "XYZ", .values = {}, .half = true}; // 11 bits suffice for parts of 1
    for (const gpu::LayerSums& pixel : sums)
    {
        const gpu::vec3 n = pixel.normal;
        const gpu::vec3 unit = n.x == 0 && n.y == 0 && n.z == 0 ? n : normalize(n);
        layer.values.insert(layer.values.end(), {unit.x, unit.y, unit.z});
    }
    return layer;
}

Layer depthOf(std::span<const gpu::LayerSums> sums)
{
    Layer layer{.name = "", .channels = "Z", .values = {}};
    for (const gpu::LayerSums& pixel : sums)
        layer.values.push_back(pixel.depth < gpu::kSkyDepth ? pixel.depth : INFINITY);
    return layer;
}

Layer motionsOf(std::span<const gpu::LayerSums> sums)
{
    Layer layer{.name = "motion", .channels = "XY", .values = {}};
    for (const gpu::LayerSums& pixel : sums)
        layer.values.insert(layer.values.end(), {pixel.motion.x, pixel.motion.y});
    return layer;
}

Layer layerOf(const std::string& name, std::span<const gpu::LayerSums> sums, const Renderer& renderer,
              const Device& device)
{
    const uint32_t count = std::max(renderer.sampleCount(), 1u);
    if (name == "beauty")
        return pictureOf(renderer, device);
    if (name == "normal")
        return normalsOf(sums);
    if (name == "depth")
        return depthOf(sums);
    if (name == "motion")
        return motionsOf(sums);
    if (name == "albedo")
    {
        Layer layer = meanOf(sums, count, name, &gpu::LayerSums::albedo);
        layer.half = true;
        return layer;
    }
    return meanOf(sums, count, name,
                  name == "emission"   ? &gpu::LayerSums::emission
                  : name == "direct"   ? &gpu::LayerSums::direct
                  : name == "caustics" ? &gpu::LayerSums::caustics
                  : name == "indirect" ? &gpu::LayerSums::indirect
                                       : &gpu::LayerSums::glossy);
}

} // namespace

Capture::Capture(std::filesystem::path path, Renderer& renderer, const Device& device, const SceneGpu& scene,
                 const Settings& settings, std::span<const std::string> layers)
    : path_(std::move(path)), width_(renderer.width()), height_(renderer.height())
{
    if (!layers.empty())
    {
        const std::vector<gpu::LayerSums> sums = renderer.layerSums(device);
        for (const std::string& name : layers)
            layers_.push_back(layerOf(name, sums, renderer, device));
    }
    else if (path_.extension() == ".png")
        rgb_ = displayed(renderer, device, scene, settings);
    else
        layers_.push_back(pictureOf(renderer, device));
}

uint64_t Capture::byteCount() const
{
    uint64_t count = rgb_.size();
    for (const Layer& layer : layers_)
        count += layer.values.size() * sizeof(float);
    return count;
}

Status Capture::write(std::span<const PictureNote> notes) const
{
    if (!rgb_.empty())
        return writePng(path_, width_, height_, 3, rgb_, notes);
    std::vector<ExrLayer> layers;
    for (const Layer& layer : layers_)
        layers.push_back({layer.name, layer.channels, layer.values, layer.half});
    return writeExr(path_, width_, height_, layers, notes);
}
