// Path-traced pictures that were made before.
#pragma once
#include "format/package_read.h"
#include "image/image.h"
#include "runtime/camera.h"

#include <filesystem>
#include <functional>

/// Everything that a reference is made of besides the path tracer itself: where that changes, delete the folder.
struct ReferenceKey
{
    uint64_t package = 0; // packageHash()
    Camera camera;        // its name does not count
    uint32_t width = 0, height = 0, sample_count = 0;
    uint32_t depth_limit = 0; // Settings::reference_depth
    uint32_t term = 0;        // gpu::kTerm*
    uint64_t lights = 0;      // a hash of those that are not the package's; 0: none

    /// XXH3-64 of it.
    uint64_t hash() const;
};

/// Of everything in the package: a hash of its table of chunks, which has the hash of each.
uint64_t packageHash(const package::Package& package);

class ReferenceCache
{
public:
    /// @param folder made when the first picture is kept
    explicit ReferenceCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// The picture of that key; one that is not there, or is damaged, is rendered and kept. Several programs may do so
    /// at a time. @return kIo where it cannot be written
    Result<ImageF> picture(const ReferenceKey& key, const std::function<ImageF()>& render) const;
    std::filesystem::path fileOf(const ReferenceKey& key) const;

private:
    std::filesystem::path folder_;
};
