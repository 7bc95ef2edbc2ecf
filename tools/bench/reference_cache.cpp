#include "tools/bench/reference_cache.h"

#include "format/check.h"
#include "image/write_image.h"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <optional>
#include <xxhash.h>

namespace
{
// A file is a header and the pixels, float[3 * width * height], as this machine stores them.
struct Header
{
    uint64_t magic;
    uint32_t width, height;
    uint64_t hash; // XXH3-64 of the pixels
};
constexpr uint64_t kMagic = 0x316665722d6d756cu; // "lum-ref1"

std::optional<ImageF> read(const std::filesystem::path& path, const ReferenceKey& key)
{
    std::ifstream file(path, std::ios::binary);
    Header header{};
    ImageF image{key.width, key.height, std::vector<float>(3 * size_t(key.width) * key.height)};
    const size_t bytes = image.rgb.size() * sizeof(float);
    if (!file.read(reinterpret_cast<char*>(&header), sizeof(header)) ||
        !file.read(reinterpret_cast<char*>(image.rgb.data()), std::streamsize(bytes)) ||
        file.peek() != std::ifstream::traits_type::eof() || header.magic != kMagic || header.width != key.width ||
        header.height != key.height || header.hash != XXH3_64bits(image.rgb.data(), bytes))
        return std::nullopt;
    return image;
}

Status write(const std::filesystem::path& path, const ImageF& image)
{
    const size_t bytes = image.rgb.size() * sizeof(float);
    const Header header{kMagic, image.width, image.height, XXH3_64bits(image.rgb.data(), bytes)};
    std::vector<uint8_t> file(sizeof(header) + bytes);
    std::memcpy(file.data(), &header, sizeof(header));
    std::memcpy(file.data() + sizeof(header), image.rgb.data(), bytes);
    return writeFile(path, file);
}
} // namespace

uint64_t ReferenceKey::hash() const
{
    // One number after the other: structs may have gaps.
    std::vector<float> numbers;
    for (const gpu::vec3 v : {camera.position, camera.forward, camera.up})
        numbers.insert(numbers.end(), {v.x, v.y, v.z});
    numbers.insert(numbers.end(),
                   {camera.vertical_fov, camera.orthographic_height, camera.near_plane, camera.far_plane});
    uint64_t hash = XXH3_64bits_withSeed(numbers.data(), numbers.size() * sizeof(float), package);
    const std::array counts{width, height, sample_count, depth_limit, term};
    hash = XXH3_64bits_withSeed(counts.data(), sizeof(counts), hash);
    return lights == 0 ? hash : XXH3_64bits_withSeed(&lights, sizeof(lights), hash);
}

uint64_t packageHash(const package::Package& package)
{
    const auto chunks = std::as_bytes(package.chunks());
    return XXH3_64bits(chunks.data(), chunks.size());
}

std::filesystem::path ReferenceCache::fileOf(const ReferenceKey& key) const
{
    return folder_ / fmt::format("{:016x}-{:016x}.reference", key.package, key.hash());
}

Result<ImageF> ReferenceCache::picture(const ReferenceKey& key, const std::function<ImageF()>& render) const
{
    const std::filesystem::path path = fileOf(key);
    if (auto kept = read(path, key))
        return std::move(*kept);
    std::error_code failed;
    std::filesystem::create_directories(folder_, failed);
    if (failed)
        return Error{ExitCode::kIo, fmt::format("the folder for references cannot be made: {}", failed.message()),
                     folder_.string()};
    ImageF image = render();
    check(image.width == key.width && image.height == key.height, "{} x {}", image.width, image.height);
    if (const Status status = write(path, image); !status)
        return status.error().about(path.string());
    return image;
}
