// Pictures out of the player.
#pragma once
#include "image/picture_notes.h"
#include "runtime/renderer.h"

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Whether `path` ends in a picture format the player writes. @return kUsage naming the formats
Status checkPicturePath(const std::filesystem::path& path);

/// What an .exr can hold: the picture (channels R, G, B), its terms (direct.R, ...), what even light would show of the surface
/// (albedo.R, ...), its normal in the world (normal.X, ...), metres from the eye along the way of the light (Z; the sky is
/// infinitely far), and pixels from here to where that was in the picture before (motion.X to the right, motion.Y down). Of
/// pictures of many samples they are means; of depth and motion the last sample.
inline constexpr std::array<std::string_view, 10> kLayerNames{"beauty", "emission", "direct", "caustics", "indirect",
                                                              "glossy", "albedo",   "normal", "depth",    "motion"};

/// A picture that is no longer the renderer's, to be written while that goes on.
class Capture
{
public:
    /// Values of some channels, those of a pixel together.
    struct Layer
    {
        std::string name, channels; // as ExrLayer's
        std::vector<float> values;
        bool half = false;
    };

    /// Takes the picture so far; waits for the device.
    /// @param path where it will be written: .exr linear radiance, 32-bit; .png exposed and tone-mapped
    /// @param layers of kLayerNames, in place of the picture alone; only of .exr, and renderer.keepLayers() came before
    Capture(std::filesystem::path path, Renderer& renderer, const Device& device, const SceneGpu& scene,
            const Settings& settings, std::span<const std::string> layers = {});

    /// Encodes and writes it, on any thread. @param notes for its header
    Status write(std::span<const PictureNote> notes = {}) const;

    const std::filesystem::path& path() const { return path_; }
    uint64_t byteCount() const;

private:
    std::filesystem::path path_;
    uint32_t width_, height_;
    std::vector<uint8_t> rgb_;  // of .png
    std::vector<Layer> layers_; // of .exr
};
