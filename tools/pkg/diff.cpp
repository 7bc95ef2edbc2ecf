#include "format/mapped_file.h"
#include "format/package_container.h"
#include "format/package_read.h"
#include "tools/pkg/commands.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

namespace
{
using Json = nlohmann::ordered_json;

using ChunkId = std::pair<uint32_t, uint32_t>; // id, index

/// What is compared of a package.
struct Side
{
    package::Package package;     // verified
    package::MappedFile file;     // the same, for
    package::Container container; // its chunks as they are once decompressed
    std::string name;

    std::map<ChunkId, size_t> chunks() const // into container
    {
        std::map<ChunkId, size_t> by_id;
        for (size_t i = 0; i < container.table.size(); ++i)
            by_id[{container.table[i].id, container.table[i].index}] = i;
        return by_id;
    }
    std::vector<std::string> options() const
    {
        std::vector<std::string> all;
        const auto* options = package.meta().provenance()->options();
        for (uint32_t i = 0; options && i < options->size(); ++i)
            all.push_back(options->Get(i)->str());
        return all;
    }
    std::vector<std::pair<const char*, double>> counts() const
    {
        const lumicut::fb::Statistics& s = *package.meta().statistics();
        return {{"triangles", double(package.triangles().size())},
                {"vertices", double(package.vertexAttributes().size())},
                {"bvh_nodes", double(package.bvhNodes().size())},
                {"bvh_triangles", double(package.bvhTriangles().size())},
                {"bvh_sah_cost", double(s.bvh_sah_cost())},
                {"materials", double(package.materials().size())},
                {"texture_refs", double(package.textureRefs().size())},
                {"texture_pages", double(package.meta().texture_pages()->size())},
                {"lights", double(package.lights().size())},
                {"cameras", double(package.meta().cameras()->size())},
                {"animations", package.motion() == nullptr ? 0.0 : double(package.motion()->clips()->size())},
                {"moving_triangles", double(package.triangles().size() - package.firstMovingTriangle())},
                {"file_bytes", double(package.fileBytes())}};
    }
};

Json chunkJson(const package::ChunkEntry* entry)
{
    if (entry == nullptr)
        return nullptr;
    return {{"raw_bytes", entry->raw_bytes},
            {"stored_bytes", entry->stored_bytes},
            {"hash", fmt::format("{:016x}", entry->hash)}};
}

Result<Side> open(const std::filesystem::path& path)
{
    auto verified = package::Package::open(path);
    if (!verified)
        return verified.error();
    auto file = package::MappedFile::open(path);
    if (!file)
        return file.error();
    auto container = package::readContainer(file->bytes());
    if (!container)
        return container.error();
    return Side{std::move(*verified), std::move(*file), std::move(*container), path.string()};
}

Json compare(const Side& a, const Side& b)
{
    Json json{{"schema", "lumicut-pkg-diff/1"}, {"same", true}, {"a", a.name}, {"b", b.name}};
    json["options"] = {{"a", a.options()}, {"b", b.options()}};
    json["counts"] = Json::object();
    const auto counts_a = a.counts();
    const auto counts_b = b.counts();
    for (size_t i = 0; i < counts_a.size(); ++i)
        json["counts"][counts_a[i].first] = {{"a", counts_a[i].second}, {"b", counts_b[i].second}};
    const auto chunks_a = a.chunks();
    const auto chunks_b = b.chunks();
    auto all = chunks_a;
    all.insert(chunks_b.begin(), chunks_b.end());
    json["chunks"] = Json::array();
    for (const auto& [key, unused] : all)
    {
        const auto in_a = chunks_a.find(key);
        const auto in_b = chunks_b.find(key);
        const bool both = in_a != chunks_a.end() && in_b != chunks_b.end();
        const bool same =
            both && std::ranges::equal(a.container.chunks[in_a->second], b.container.chunks[in_b->second]);
        const auto entry = [](const Side& side, const auto& chunks, const auto& found)
        { return found == chunks.end() ? nullptr : &side.container.table[found->second]; };
        json["chunks"].push_back({{"id", package::chunkName(key.first)},
                                  {"index", key.second},
                                  {"same", same},
                                  {"a", chunkJson(entry(a, chunks_a, in_a))},
                                  {"b", chunkJson(entry(b, chunks_b, in_b))}});
        if (!same)
            json["same"] = false;
    }
    return json;
}

/// Only what differs, a minus line for A and a plus line for B.
void printText(const Json& json)
{
    if (json["same"].get<bool>())
        return;
    fmt::print("--- {}\n+++ {}\n", json["a"].get<std::string>(), json["b"].get<std::string>());
    const auto options = [&](const char* side, char sign)
    {
        for (const Json& option : json["options"][side])
        {
            const Json& other = json["options"][side[0] == 'a' ? "b" : "a"];
            if (std::find(other.begin(), other.end(), option) == other.end())
                fmt::print("{}option {}\n", sign, printable(option.get<std::string>()));
        }
    };
    options("a", '-');
    options("b", '+');
    for (const auto& [name, count] : json["counts"].items())
        if (count["a"] != count["b"])
            fmt::print("-{0} {1}\n+{0} {2}\n", name, count["a"].get<double>(), count["b"].get<double>());
    for (const Json& chunk : json["chunks"])
        for (const auto& [side, sign] : {std::pair("a", '-'), std::pair("b", '+')})
            if (!chunk["same"].get<bool>() && !chunk[side].is_null())
                fmt::print("{}chunk {} {}: {} bytes, {}\n", sign, chunk["id"].get<std::string>(),
                           chunk["index"].get<uint32_t>(), chunk[side]["raw_bytes"].get<uint64_t>(),
                           chunk[side]["hash"].get<std::string>());
}
} // namespace

int diff(const std::filesystem::path& a, const std::filesystem::path& b, TextFormat format)
{
    const Result<Side> side_a = open(a);
    const Result<Side> side_b = open(b);
    if (!side_a)
        report(a, side_a.error());
    if (!side_b)
        report(b, side_b.error());
    if (!side_a || !side_b)
        return kDiffTrouble;
    const Json json = compare(*side_a, *side_b);
    if (format == TextFormat::kJson)
        fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
    else
        printText(json);
    return json["same"].get<bool>() ? 0 : 1;
}
