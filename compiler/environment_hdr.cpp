#include "compiler/environment_files.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#include <stb_image.h>

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>

static_assert(STBI_MAX_DIMENSIONS == kMaxEnvironmentSide);

Result<EnvironmentImage> readHdr(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    if (file.bad())
        return Error{ExitCode::kIo, "the HDR image cannot be read to its end"};
    if (bytes.size() > size_t(std::numeric_limits<int>::max()))
        return Error{ExitCode::kUnsupported, "the HDR image is larger than 2 GiB"};

    int width = 0;
    int height = 0;
    const std::unique_ptr<float, void (*)(void*)> texels(
        stbi_loadf_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), int(bytes.size()), &width, &height,
                               nullptr, 4),
        stbi_image_free);
    if (!texels)
        return Error{ExitCode::kInvalid, fmt::format("the HDR image cannot be read: {}", stbi_failure_reason())};

    EnvironmentImage image{.width = uint32_t(width), .height = uint32_t(height), .texels = {}};
    image.texels.resize(size_t(width) * size_t(height));
    std::memcpy(image.texels.data(), texels.get(), image.texels.size() * sizeof(gpu::vec4));
    return image;
}
