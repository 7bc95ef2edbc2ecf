#include "runtime/capture.h"

#include "image/write_image.h"

#include <algorithm>
#include <cmath>

Status checkPicturePath(const std::filesystem::path& path)
{
    if (path.extension() == ".exr" || path.extension() == ".png")
        return Success{};
    return Error{ExitCode::kUsage, "pictures are written as .exr or .png", path.string()};
}

namespace
{
Status capturePng(const std::filesystem::path& path, Renderer& renderer, const Device& device, const SceneGpu& scene,
                  const Settings& settings, std::span<const PictureNote> notes)
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
    return writePng(path, renderer.width(), renderer.height(), 3, rgb, notes);
}
/// A layer's name, its channels and their values, interleaved.
struct LayerValues
{
    std::string name, channels;
    std::vector<float> values;
    bool half = false;
};

/// A member of LayerSums as the mean over `count` frames.
LayerValues meanOf(std::span<const gpu::LayerSums> sums, uint32_t count, const std::string& name,
                   gpu::vec3 gpu::LayerSums::*member)
{
    LayerValues layer{.name = name, .channels = "RGB", .values = {}};
    for (const gpu::LayerSums& pixel : sums)
    {
        const gpu::vec3 mean = 1 / float(count) * (pixel.*member);
        layer.values.insert(layer.values.end(), {mean.x, mean.y, mean.z});
    }
    return layer;
}

LayerValues normalsOf(std::span<const gpu::LayerSums> sums)
{
    LayerValues layer{
        .name = "normal", .channels = "XYZ", .values = {}, .half = true}; // 11 bits suffice for parts of 1
    for (const gpu::LayerSums& pixel : sums)
    {
        const gpu::vec3 n = pixel.normal;
        const gpu::vec3 unit = n.x == 0 && n.y == 0 && n.z == 0 ? n : normalize(n);
        layer.values.insert(layer.values.end(), {unit.x, unit.y, unit.z});
    }
    return layer;
}

LayerValues depthOf(std::span<const gpu::LayerSums> sums)
{
    LayerValues layer{.name = "", .channels = "Z", .values = {}};
    for (const gpu::LayerSums& pixel : sums)
        layer.values.push_back(pixel.depth < gpu::kSkyDepth ? pixel.depth : INFINITY);
    return layer;
}

LayerValues motionsOf(std::span<const gpu::LayerSums> sums)
{
    LayerValues layer{.name = "motion", .channels = "XY", .values = {}};
    for (const gpu::LayerSums& pixel : sums)
        layer.values.insert(layer.values.end(), {pixel.motion.x, pixel.motion.y});
    return layer;
}

LayerValues layerOf(const std::string& name, std::span<const gpu::LayerSums> sums, const Renderer& renderer,
                    const Device& device)
{
    const uint32_t count = std::max(renderer.sampleCount(), 1u);
    if (name == "beauty")
    {
        LayerValues layer{.name = "", .channels = "RGB", .values = {}};
        for (const gpu::vec3& pixel : renderer.picture(device))
            layer.values.insert(layer.values.end(), {pixel.x, pixel.y, pixel.z});
        return layer;
    }
    if (name == "normal")
        return normalsOf(sums);
    if (name == "depth")
        return depthOf(sums);
    if (name == "motion")
        return motionsOf(sums);
    if (name == "albedo")
    {
        LayerValues layer = meanOf(sums, count, name, &gpu::LayerSums::albedo);
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

Status captureLayers(const std::filesystem::path& path, const Renderer& renderer, const Device& device,
                     std::span<const std::string> names, std::span<const PictureNote> notes)
{
    const std::vector<gpu::LayerSums> sums = renderer.layerSums(device);
    std::vector<LayerValues> values;
    for (const std::string& name : names)
        values.push_back(layerOf(name, sums, renderer, device));
    std::vector<ExrLayer> layers;
    for (const LayerValues& layer : values)
        layers.push_back({layer.name, layer.channels, layer.values, layer.half});
    return writeExr(path, renderer.width(), renderer.height(), layers, notes);
}
} // namespace

Status capture(const std::filesystem::path& path, Renderer& renderer, const Device& device, const SceneGpu& scene,
               const Settings& settings, std::span<const std::string> layers, std::span<const PictureNote> notes)
{
    if (!layers.empty())
        return captureLayers(path, renderer, device, layers, notes);
    if (path.extension() == ".png")
        return capturePng(path, renderer, device, scene, settings, notes);
    ImageF image{.width = renderer.width(), .height = renderer.height()};
    for (const gpu::vec3& pixel : renderer.picture(device))
        image.rgb.insert(image.rgb.end(), {pixel.x, pixel.y, pixel.z});
    return writeExr(path, image, notes);
}
