#include "runtime/capture.h"

#include "image/write_image.h"

Status checkPicturePath(const std::filesystem::path& path)
{
    if (path.extension() == ".exr" || path.extension() == ".png")
        return Success{};
    return Error{ExitCode::kUsage, "pictures are written as .exr or .png", path.string()};
}

namespace
{
Status capturePng(const std::filesystem::path& path, Renderer& renderer, const Device& device, const SceneGpu& scene,
                  const Settings& settings)
{
    Recorder rec(device);
    rec.begin(scene.descriptorSet());
    const Buffer& pixels = renderer.display(rec, settings, false);
    rec.submitAndWait();
    const std::vector<uint32_t> rgba = device.download<uint32_t>(pixels, uint64_t(renderer.width()) * renderer.height());
    std::vector<uint8_t> rgb;
    rgb.reserve(rgba.size() * 3);
    for (const uint32_t pixel : rgba)
        for (const uint32_t shift : {0u, 8u, 16u})
            rgb.push_back(uint8_t(pixel >> shift));
    return writePng(path, renderer.width(), renderer.height(), 3, rgb);
}
} // namespace

Status capture(const std::filesystem::path& path, Renderer& renderer, const Device& device, const SceneGpu& scene,
               const Settings& settings)
{
    if (path.extension() == ".png")
        return capturePng(path, renderer, device, scene, settings);
    ImageF image{.width = renderer.width(), .height = renderer.height()};
    for (const gpu::vec3& pixel : renderer.picture(device))
        image.rgb.insert(image.rgb.end(), {pixel.x, pixel.y, pixel.z});
    return writeExr(path, image);
}
