#include "runtime/texture_pages.h"

#include "format/parallel.h"
#include "format/texture_encoding.h"

#include <algorithm>
#include <functional>

namespace
{
using package::TextureEncoding;

VkFormat vulkanFormat(TextureEncoding encoding)
{
    switch (encoding)
    {
    case TextureEncoding::Rgba8Srgb:
        return VK_FORMAT_R8G8B8A8_SRGB;
    case TextureEncoding::Bc7Srgb:
        return VK_FORMAT_BC7_SRGB_BLOCK;
    case TextureEncoding::Bc7Unorm:
        return VK_FORMAT_BC7_UNORM_BLOCK;
    case TextureEncoding::Bc5Unorm:
        return VK_FORMAT_BC5_UNORM_BLOCK;
    case TextureEncoding::Bc4Unorm:
        return VK_FORMAT_BC4_UNORM_BLOCK;
    case TextureEncoding::Rgba8Unorm:
        break;
    }
    return VK_FORMAT_R8G8B8A8_UNORM;
}

blocks::Texels decodeBlock(TextureEncoding encoding, const std::byte* block)
{
    return encoding == TextureEncoding::Bc4Unorm   ? blocks::decodeBc4(std::span<const std::byte, 8>(block, 8))
           : encoding == TextureEncoding::Bc5Unorm ? blocks::decodeBc5(std::span<const std::byte, 16>(block, 16))
                                                   : blocks::decodeBc7(std::span<const std::byte, 16>(block, 16));
}

/// One layer of one level.
void decodeLevel(TextureEncoding encoding, const std::byte* block, uint32_t width, uint32_t height, std::byte* out)
{
    for (uint32_t y = 0; y < height; y += blocks::kSide)
        for (uint32_t x = 0; x < width; x += blocks::kSide, block += package::unitBytes(encoding))
        {
            const blocks::Texels texels = decodeBlock(encoding, block);
            const uint32_t columns = std::min(blocks::kSide, width - x), rows = std::min(blocks::kSide, height - y);
            for (uint32_t row = 0; row < rows; ++row)
                std::memcpy(out + 4 * ((size_t(y) + row) * width + x), &texels[blocks::kSide * row],
                            size_t(4) * columns);
        }
}
} // namespace

std::vector<std::byte> decodePage(const lumicut::fb::TexturePage& page, std::span<const std::byte> bytes)
{
    std::vector<std::function<Status()>> tasks;
    std::vector<std::byte> texels;
    size_t source = 0, target = 0;
    for (uint32_t level = 0; level < page.levels(); ++level)
    {
        const uint32_t width = std::max(page.width() >> level, 1u), height = std::max(page.height() >> level, 1u);
        for (uint32_t layer = 0; layer < page.layers(); ++layer)
        {
            tasks.emplace_back(
                [&texels, &page, from = bytes.data() + source, width, height, target]() -> Status
                {
                    decodeLevel(page.encoding(), from, width, height, texels.data() + target);
                    return Success{};
                });
            source += package::levelBytes(page.encoding(), width, height);
            target += size_t(4) * width * height;
        }
    }
    check(source == bytes.size(), "{} bytes of blocks, expected {}", bytes.size(), source);
    texels.resize(target);
    check(bool(package::runAll(tasks, true)), "decoding blocks cannot fail");
    return texels;
}

Image uploadTexturePage(const Device& device, const package::Package& package, uint32_t index)
{
    const lumicut::fb::TexturePage& page = *(*package.meta().texture_pages())[index];
    TextureEncoding encoding = page.encoding();
    std::span<const std::byte> bytes = package.texturePage(index);
    std::vector<std::byte> decoded;
    if (package::isBlocks(encoding) && !device.samplesBlocks())
    {
        decoded = decodePage(page, bytes);
        bytes = decoded;
        encoding = package::isSrgb(encoding) ? TextureEncoding::Rgba8Srgb : TextureEncoding::Rgba8Unorm;
    }
    return device.uploadImage(fmt::format("scene.page_{}", index),
                              {.format = vulkanFormat(encoding),
                               .width = page.width(),
                               .height = page.height(),
                               .layers = page.layers(),
                               .levels = page.levels(),
                               .array = true},
                              bytes);
}
