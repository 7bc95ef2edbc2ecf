// Texels and blocks of KTX 2.0 files by their Vulkan format.
#pragma once
#include "compiler/ktx2.h"

#include <optional>

enum class Ktx2Kind
{
    kUnorm8,
    kUnorm16,
    kFloat16,
    kFloat32,
    kBc1, // with or without alpha
    kBc2,
    kBc3,
    kBc4,
    kBc5,
    kBc7
};

struct Ktx2Format
{
    Ktx2Kind kind = Ktx2Kind::kUnorm8;
    uint32_t channels = 4; // of texels
    bool bgr = false;
    bool alpha = true; // of BC1: whether blocks may be transparent
};

/// @param vk_format VkFormat. @return nothing for a format that is not read
std::optional<Ktx2Format> ktx2Format(uint32_t vk_format);

/// Of one level, without padding.
uint64_t ktx2LevelBytes(const Ktx2Format& format, uint32_t width, uint32_t height);

/// Decodes one level into `image`, whose sides are set. @param bytes ktx2LevelBytes() of them
void decodeKtx2Level(const Ktx2Format& format, std::span<const std::byte> bytes, Ktx2Image& image);
