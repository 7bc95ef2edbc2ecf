#include "compiler/gltf_document.h"

#include "format/bad_json.h"

#include <fmt/format.h>

#include <algorithm>

using nlohmann::json;

namespace
{
constexpr int kMaxJsonDepth = 128; // tinygltf walks extensions recursively

struct Container
{
    std::string_view json; // borrowed
    std::optional<ByteView> bin;
};

uint32_t readU32(const std::vector<unsigned char>& bytes, size_t offset)
{
    return uint32_t(bytes[offset]) | uint32_t(bytes[offset + 1]) << 8 | uint32_t(bytes[offset + 2]) << 16 |
           uint32_t(bytes[offset + 3]) << 24;
}

/// Splits a binary glTF into its JSON and BIN chunks; unknown chunks are skipped.
Result<Container> splitGlb(const std::vector<unsigned char>& bytes)
{
    if (bytes.size() < 20)
        return Error{ExitCode::kInvalid, "the binary glTF ends inside its header; export or copy it again"};
    const uint32_t version = readU32(bytes, 4);
    const uint64_t total = readU32(bytes, 8);
    if (version != 2)
        return Error{ExitCode::kUnsupported, fmt::format("binary glTF version {} is not supported, only 2", version)};
    if (total > bytes.size())
        return Error{ExitCode::kInvalid,
                     fmt::format("the file is cut short: its header says {} bytes, it has {}", total, bytes.size())};
    Container container;
    uint64_t offset = 12;
    for (int chunk = 0; offset + 8 <= total; ++chunk)
    {
        const uint64_t length = readU32(bytes, offset);
        const uint32_t type = readU32(bytes, offset + 4);
        if (offset + 8 + length > total)
            return Error{ExitCode::kInvalid, fmt::format("chunk {} of the binary glTF reaches past its end", chunk)};
        const unsigned char* data = bytes.data() + offset + 8;
        if (chunk == 0 && type != 0x4E4F534A)
            return Error{ExitCode::kInvalid, "the first chunk of the binary glTF is not JSON"};
        if (chunk == 0)
            container.json = {reinterpret_cast<const char*>(data), size_t(length)};
        else if (type == 0x004E4942 && !container.bin)
            container.bin = ByteView{data, size_t(length), 0};
        offset += 8 + ((length + 3) & ~uint64_t(3));
    }
    return container;
}

/// Nesting depth of brackets outside strings, so that no recursive walk of a hostile file runs out of stack.
int jsonDepth(std::string_view text)
{
    int depth = 0;
    int deepest = 0;
    bool in_string = false;
    for (size_t i = 0; i < text.size(); ++i)
    {
        const char c = text[i];
        if (in_string && c == '\\')
            ++i;
        else if (c == '"')
            in_string = !in_string;
        else if (!in_string && (c == '{' || c == '['))
            deepest = std::max(deepest, ++depth);
        else if (!in_string && (c == '}' || c == ']'))
            --depth;
    }
    return deepest;
}

Result<json> parseJson(std::string_view text)
{
    if (jsonDepth(text) > kMaxJsonDepth)
        return Error{ExitCode::kInvalid, fmt::format("its JSON is nested deeper than {} levels", kMaxJsonDepth)};
    if (text.starts_with("\xEF\xBB\xBF"))
        text.remove_prefix(3);
    try
    {
        json document = json::parse(text);
        if (!document.is_object())
            return Error{ExitCode::kInvalid, "its JSON is not an object, so it is no glTF file"};
        return document;
    }
    catch (const json::exception& e)
    {
        return badJson(e.what());
    }
}

Status checkVersion(const json& document)
{
    const auto asset = document.find("asset");
    if (asset == document.end() || !asset->is_object() || !asset->contains("version") ||
        !(*asset)["version"].is_string())
        return Error{ExitCode::kInvalid, "it does not say which glTF version it is (/asset/version)"};
    const std::string version = (*asset)["version"];
    if (!version.starts_with("2."))
        return Error{ExitCode::kUnsupported,
                     fmt::format("glTF version {} is not supported, only 2.0 (/asset/version)", version.substr(0, 16))};
    if (const auto minimum = asset->find("minVersion");
        minimum != asset->end() && minimum->is_string() && *minimum != "2.0")
        return Error{ExitCode::kUnsupported, fmt::format("it asks for a reader of glTF {} at least, this one knows 2.0 "
                                                         "(/asset/minVersion)",
                                                         minimum->get<std::string>().substr(0, 16))};
    return Success{};
}

} // namespace

Result<GltfDocument> parseDocument(const std::vector<unsigned char>& bytes)
{
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.empty())
        return Error{ExitCode::kInvalid, "the file is empty"};
    Result<Container> container = Container{text, std::nullopt};
    if (text.starts_with("glTF"))
        container = splitGlb(bytes);
    if (!container)
        return container.error();
    Result<json> document = parseJson(container->json);
    if (!document)
        return document.error();
    if (const Status status = checkVersion(*document); !status)
        return status.error();
    return GltfDocument{std::move(*document), container->bin};
}
