// Brings a package's texture pages to the device.
#pragma once
#include "format/package_read.h"
#include "runtime/gpu/gpu.h"

/// Blocks stay blocks where the device reads them well; elsewhere they become RGBA8 here: software Vulkan would decode one
/// anew for every texel that it reads.
Image uploadTexturePage(const Device& device, const package::Package& package, uint32_t page);

/// Blocks of all layers and levels as RGBA8, in the same order.
/// @param bytes as in chunk TEXP, of a page whose encoding isBlocks()
std::vector<std::byte> decodePage(const lumicut::fb::TexturePage& page, std::span<const std::byte> bytes);
