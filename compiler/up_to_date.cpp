#include "compiler/up_to_date.h"

#include "compiler/input_files.h"
#include "compiler/parallel.h"
#include "format/mapped_file.h"
#include "format/package_container.h"

#include <algorithm>
#include <cstring>
#include <fstream>

namespace
{
bool holds(const std::filesystem::path& path, const lumicut::fb::Hash128* content)
{
    const std::optional<ContentHash> now = contentOf(path);
    if (!now || content == nullptr)
        return !now && content == nullptr;
    return now->low == content->low() && now->high == content->high();
}
} // namespace

uint64_t packageHash(const std::filesystem::path& package)
{
    package::Header header{};
    std::ifstream stream(package, std::ios::binary);
    stream.read(reinterpret_cast<char*>(&header), sizeof header);
    return stream ? header.header_hash : 0;
}

std::optional<PackageOrigin> readOrigin(const std::filesystem::path& package)
{
    const Result<package::MappedFile> file = package::MappedFile::open(package);
    if (!file)
        return std::nullopt;
    const Result<package::Container> container = package::readContainer(file->bytes(), package::Unpack::kMeta);
    if (!container)
        return std::nullopt;
    const std::span<const std::byte> meta = container->find(package::kMetaChunk);
    flatbuffers::Verifier verifier(reinterpret_cast<const uint8_t*>(meta.data()), meta.size(), 16, 65536);
    if (meta.empty() || !lumicut::fb::VerifyMetaBuffer(verifier))
        return std::nullopt;
    PackageOrigin origin;
    lumicut::fb::GetMeta(meta.data())->provenance()->UnPackTo(&origin.provenance);
    std::memcpy(&origin.hash, file->bytes().data() + offsetof(package::Header, header_hash), sizeof origin.hash);
    return origin;
}

bool isUpToDate(const CompileOptions& options, const PackageOrigin& origin)
{
    const lumicut::fb::ProvenanceT& p = origin.provenance;
    if (p.compiler != compilerHash() || p.options != options.text || p.source != options.input.filename().string() ||
        p.inputs.empty())
        return false;
    if (options.environment
            ? p.environment_content == nullptr || !holds(*options.environment, p.environment_content.get())
            : p.environment_content != nullptr)
        return false;
    std::vector<uint8_t> same(p.inputs.size());
    parallelFor(same.size(),
                [&](size_t i)
                {
                    const lumicut::fb::InputFileT& input = *p.inputs[i];
                    same[i] = holds(options.input.parent_path() / input.name, input.content.get());
                });
    return std::all_of(same.begin(), same.end(), [](uint8_t s) { return s != 0; });
}

std::vector<std::filesystem::path> inputPaths(const CompileOptions& options, const lumicut::fb::ProvenanceT& provenance)
{
    std::vector<std::filesystem::path> paths{options.input};
    for (const auto& input : provenance.inputs)
        if (const auto path = options.input.parent_path() / input->name; path != options.input)
            paths.push_back(path);
    if (options.environment)
        paths.push_back(*options.environment);
    return paths;
}
