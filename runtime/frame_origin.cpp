#include "runtime/frame_origin.h"

#include "format/mapped_file.h"
#include "format/package_layout.h"
#include "runtime/gpu/kernel.h"
#include "runtime/source_hash.h"

#include <cstring>

namespace
{
/// Fowler-Noll-Vo (FNV-1a), to tell apart what differs by accident.
class Hash
{
public:
    void add(std::span<const std::byte> bytes)
    {
        for (const std::byte byte : bytes)
            state_ = (state_ ^ uint64_t(byte)) * 0x100000001b3u;
    }
    std::string text() const { return fmt::format("{:016x}", state_); }

private:
    uint64_t state_ = 0xcbf29ce484222325u;
};

Result<std::string> fileHash(const std::filesystem::path& path)
{
    if (path.empty())
        return std::string();
    const auto file = package::MappedFile::open(path);
    if (!file)
        return file.error().about(path.string());
    Hash hash;
    hash.add(file->bytes());
    return hash.text();
}

/// Not verified: whoever opens the package does that.
Result<std::string> packageHash(const std::filesystem::path& path)
{
    const auto file = package::MappedFile::open(path);
    if (!file)
        return file.error();
    package::Header header{};
    if (file->bytes().size() < sizeof(header))
        return Error{ExitCode::kInvalid, "is not a package, or cut off"};
    std::memcpy(&header, file->bytes().data(), sizeof(header));
    if (header.magic != package::kMagic)
        return Error{ExitCode::kInvalid, "is not a package"};
    return fmt::format("{:016x}", header.header_hash);
}

std::string playerVersion()
{
    static const std::string version = []
    {
        Hash hash;
        for (const KernelCode& kernel : kernelCodes())
            hash.add(std::as_bytes(kernel.words));
        hash.add(std::as_bytes(std::span(kSourceHash))); // plans, tables and poses come from the CPU
        return fmt::format("{} {}", LUMICUT_VERSION, hash.text());
    }();
    return version;
}

std::string joined(std::span<const std::string> texts)
{
    std::string all;
    for (const std::string& text : texts)
        all += (all.empty() ? "" : ",") + text;
    return all;
}

Result<std::string> settingsText(const PlayerOptions& options, const Settings& settings)
{
    const auto path = fileHash(options.path), against = fileHash(options.against);
    for (const auto* hash : {&path, &against})
        if (!*hash)
            return hash->error();
    std::string text;
    const auto add = [&](std::string_view name, const auto& value) { text += fmt::format("{} {}\n", name, value); };
    add("mode", options.mode == Mode::kGi ? "gi" : options.mode == Mode::kReference ? "reference" : "direct");
    add("seed", options.seed);
    add("spp", options.samples ? 0 : options.sample_count);
    add("layers", joined(options.layers));
    add("camera", options.camera);
    add("animation", options.animation);
    add("time", options.seconds ? fmt::format("{}", *options.seconds) : "");
    add("path", *path);
    add("fps", options.sequence ? fmt::format("{}", options.fps) : "");
    const bool remembers = options.sequence && options.mode == Mode::kGi && options.sample_count == 0;
    add("part", remembers ? fmt::format("{}", options.part) : "");
    add("against", *against);
    for (const Setting& setting : allSettings())
        std::visit([&](auto member) { add(setting.name, settings.*member); }, setting.member);
    return text;
}

} // namespace

Result<PictureOrigin> frameOrigin(const PlayerOptions& options, const Settings& settings)
{
    const auto package = packageHash(options.package);
    if (!package)
        return package.error();
    const auto text = settingsText(options, settings);
    if (!text)
        return text.error();
    return PictureOrigin{.package = *package,
                         .version = playerVersion(),
                         .settings = *text,
                         .samples =
                             options.samples ? fmt::format("{}-{}", options.samples->first, options.samples->last) : "",
                         .device = {}};
}

Result<std::vector<PictureOrigin>> possibleOrigins(const PlayerOptions& options)
{
    std::vector<PictureOrigin> origins;
    for (const std::string preset : {"default", "preview"})
    {
        if (!options.preset.empty() && !origins.empty())
            break;
        const auto settings = makeSettings(options.preset.empty() ? preset : options.preset, options.assignments);
        if (!settings)
            return settings.error();
        auto origin = frameOrigin(options, *settings);
        if (!origin)
            return origin.error();
        origins.push_back(std::move(*origin));
    }
    return origins;
}
