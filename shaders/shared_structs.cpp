#include "shaders/shared_structs.h"

#include <algorithm>
#include <fstream>
#include <utility>
#include <vector>

using nlohmann::json;

namespace
{
uint32_t memberBytes(const json& types, const json& member)
{
    if (member.contains("array"))
        return member.at("array_stride").get<uint32_t>() * member.at("array").at(0).get<uint32_t>();
    return typeBytes(types, member.at("type"));
}

/// What follows `keyword` in `line` up to one of `ends`; "" where the line does not begin with it.
std::string wordAfter(const std::string& line, const std::string& keyword, const char* ends)
{
    return line.starts_with(keyword)
               ? line.substr(keyword.size(), line.find_first_of(ends, keyword.size()) - keyword.size())
               : "";
}
} // namespace

uint32_t typeBytes(const json& types, const std::string& type)
{
    static const std::vector<std::pair<std::string, uint32_t>> kSizes{
        {"float", 4}, {"uint", 4},   {"int", 4},   {"vec2", 8},   {"uvec2", 8},
        {"vec3", 12}, {"uvec3", 12}, {"vec4", 16}, {"uvec4", 16}, {"mat4", 64}};
    for (const auto& [name, bytes] : kSizes)
        if (name == type)
            return bytes;
    uint32_t end = 0;
    for (const auto& member : types.at(type).at("members"))
        end = std::max(end, member.at("offset").get<uint32_t>() + memberBytes(types, member));
    return end;
}

void SharedStructs::findHeaders(const std::filesystem::path& file, std::set<std::filesystem::path>& seen,
                                Headers& headers) const
{
    if (!seen.insert(file).second)
        return;
    std::ifstream in(root_ / file);
    for (std::string line; std::getline(in, line);)
    {
        if (const std::string included = wordAfter(line, "#include \"", "\""); !included.empty())
            findHeaders(included, seen, headers);
        if (const std::string name = wordAfter(line, "struct ", " ;"); !name.empty() && file.extension() == ".h")
            headers[name] = file.string();
    }
}

/// @return whether a shared header defines the struct
bool SharedStructs::addStruct(const std::string& type, const json& types, const Headers& headers)
{
    if (!types.contains(type))
        return false; // a scalar or a vector
    const json& members = types.at(type).at("members");
    for (const json& member : members)
        addStruct(member.at("type"), types, headers);
    const std::string name = types.at(type).at("name");
    const auto header = headers.find(name);
    if (header == headers.end())
        return false; // a block, or the kernel's own
    includes_.insert("#include \"" + header->second + "\"\n");
    const std::string qualified = "gpu::" + name;
    for (const json& member : members)
    {
        const std::string field = member.at("name");
        assertions_.insert("static_assert(offsetof(" + qualified + ", " + field +
                           ") == " + std::to_string(member.at("offset").get<uint32_t>()) + " && sizeof(" + qualified +
                           "::" + field + ") == " + std::to_string(memberBytes(types, member)) + ", \"" + name + "." +
                           field + " lies elsewhere in kernels\");\n");
    }
    assertions_.insert("static_assert(sizeof(" + qualified + ") == " + std::to_string(typeBytes(types, type)) + ", \"" +
                       name + " has another size in kernels\");\n");
    return true;
}

std::string SharedStructs::add(const std::filesystem::path& source, const json& reflection)
{
    Headers headers;
    std::set<std::filesystem::path> seen;
    findHeaders(source, seen, headers);
    for (const char* kind : {"push_constants", "ssbos", "ubos"})
        for (const json& block : reflection.value(kind, json::array()))
            for (const json& member : reflection.at("types").at(block.at("type").get<std::string>()).at("members"))
                if (!addStruct(member.at("type"), reflection.at("types"), headers) &&
                    kind == std::string("push_constants"))
                    return "the parameter '" + member.at("name").get<std::string>() +
                           "' is no struct of a header that " + source.string() + " includes";
    return "";
}

void SharedStructs::write(std::ostream& out) const
{
    for (const auto* lines : {&includes_, &assertions_})
        for (const std::string& line : *lines)
            out << line;
}
