#include "format/mapped_file.h"
#include "format/package_read.h"
#include "tools/pkg/commands.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

namespace
{
using Json = nlohmann::ordered_json;

/// What is compared of a package.
struct Side
{
    package::Package package;
    std::string name;

    std::map<std::pair<uint32_t, uint32_t>, package::ChunkEntry> chunks() const
    {
        std::map<std::pair<uint32_t, uint32_t>, package::ChunkEntry> by_id;
        for (const package::ChunkEntry& entry : package.chunks())
            by_id[{entry.id, entry.index}] = entry;
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

/// Hashes are of stored bytes: packages that are compressed otherwise differ.
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
        const package::ChunkEntry* const entry_a = in_a == chunks_a.end() ? nullptr : &in_a->second;
        const package::ChunkEntry* const entry_b = in_b == chunks_b.end() ? nullptr : &in_b->second;
        const bool same = entry_a && entry_b && entry_a->hash == entry_b->hash && entry_a->codec == entry_b->codec &&
                          entry_a->stored_bytes == entry_b->stored_bytes;
        json["chunks"].push_back({{"id", package::chunkName(key.first)},
                                  {"index", key.second},
                                  {"same", same},
                                  {"a", chunkJson(entry_a)},
                                  {"b", chunkJson(entry_b)}});
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
                fmt::print("{}option {}\n", sign, option.get<std::string>());
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
    auto package_a = package::Package::open(a);
    auto package_b = package::Package::open(b);
    if (!package_a)
        report(a, package_a.error());
    if (!package_b)
        report(b, package_b.error());
    if (!package_a || !package_b)
        return kDiffTrouble;
    const Json json = compare({std::move(*package_a), a.string()}, {std::move(*package_b), b.string()});
    if (format == TextFormat::kJson)
        fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
    else
        printText(json);
    return json["same"].get<bool>() ? 0 : 1;
}
