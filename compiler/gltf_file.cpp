#include "compiler/gltf_file.h"

#include "compiler/gltf_extensions.h"
#include "compiler/gltf_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>

using nlohmann::json;
using Bytes = std::vector<unsigned char>;

namespace
{
constexpr int kMaxJsonDepth = 128; // tinygltf walks extensions recursively

struct Container
{
    std::string_view json; // borrowed
    std::optional<ByteView> bin;
};

uint32_t readU32(const Bytes& bytes, size_t offset)
{
    return uint32_t(bytes[offset]) | uint32_t(bytes[offset + 1]) << 8 | uint32_t(bytes[offset + 2]) << 16 |
           uint32_t(bytes[offset + 3]) << 24;
}

/// Splits a binary glTF into its JSON and BIN chunks; unknown chunks are skipped.
Result<Container> splitGlb(const Bytes& bytes)
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
        std::string reason = e.what(); // "[json.exception.parse_error.101] parse error at line 1, ...: ..."
        if (const size_t end = reason.find("] "); end != std::string::npos)
            reason.erase(0, end + 2);
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        return Error{ExitCode::kInvalid, fmt::format("its JSON cannot be read: {}", reason)};
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

bool isMeshoptFallback(const json& buffer)
{
    const auto extensions = buffer.find("extensions");
    return extensions != buffer.end() && extensions->is_object() &&
           (extensions->contains("EXT_meshopt_compression") || extensions->contains("KHR_meshopt_compression"));
}

/// Reads buffer `i`, exactly byteLength bytes of it.
Result<Bytes> readBuffer(const json& buffer, size_t i, const std::optional<ByteView>& bin,
                         const std::filesystem::path& folder)
{
    const auto length = buffer.find("byteLength");
    if (length == buffer.end() || !length->is_number_unsigned() || *length == 0u)
        return Error{ExitCode::kInvalid, fmt::format("a buffer has no valid byteLength (/buffers/{})", i)};
    const size_t bytes = length->get<size_t>();
    const auto too_short = [&](size_t have)
    {
        return Error{ExitCode::kInvalid,
                     fmt::format("a buffer should have {} bytes, but only {} are there (/buffers/{})", bytes, have, i)};
    };
    const auto uri = buffer.find("uri");
    if (uri == buffer.end())
    {
        if (i == 0 && bin)
            return bin->bytes < bytes ? Result<Bytes>(too_short(bin->bytes)) : Bytes(bin->data, bin->data + bytes);
        if (isMeshoptFallback(buffer))
            return Error{ExitCode::kUnsupported,
                         fmt::format("its geometry is there in meshopt-compressed form only, which is not supported; "
                                     "export it without meshopt compression (/buffers/{})",
                                     i)};
        return Error{ExitCode::kInvalid, fmt::format("a buffer has no data: it names no file (/buffers/{})", i)};
    }
    if (!uri->is_string())
        return Error{ExitCode::kInvalid, fmt::format("a string is expected (/buffers/{}/uri)", i)};
    Result<Bytes> data = readUri(uri->get<std::string>(), folder);
    if (!data)
        return Error{data.error().code, fmt::format("{} (/buffers/{})", data.error().message, i)};
    if (data->size() < bytes)
        return too_short(data->size());
    data->resize(bytes);
    return data;
}

Result<std::vector<GltfImage>> takeImages(json& document)
{
    std::vector<GltfImage> images;
    const auto list = document.find("images");
    if (list == document.end())
        return images;
    for (size_t i = 0; i < list->size(); ++i)
    {
        const json& from = (*list)[i];
        const auto text = [&](const char* key)
        { return from.contains(key) && from[key].is_string() ? from[key].get<std::string>() : std::string(); };
        GltfImage image{text("name"), text("uri"), -1};
        if (const auto view = from.find("bufferView"); view != from.end() && view->is_number_integer())
            image.buffer_view = view->get<int>();
        if (!image.uri.empty() && !image.uri.starts_with("data:"))
            image.name = image.uri;
        if (image.name.empty())
            image.name = fmt::format("image {}", i);
        images.push_back(std::move(image));
    }
    document.erase("images");
    return images;
}

/// tinygltf refuses index accessors without a buffer view, which is how Draco files have them: lend them Draco's.
void lendDracoViews(json& document)
{
    const auto member = [](json& object, const char* key) -> json*
    {
        const auto it = object.is_object() ? object.find(key) : object.end();
        return it == object.end() ? nullptr : &*it;
    };
    json* accessors = member(document, "accessors");
    json* meshes = member(document, "meshes");
    if (accessors == nullptr || meshes == nullptr)
        return;
    for (json& mesh : *meshes)
    {
        json* primitives = member(mesh, "primitives");
        if (primitives == nullptr || !primitives->is_array())
            continue;
        for (json& primitive : *primitives)
        {
            json* indices = member(primitive, "indices");
            json* extensions = member(primitive, "extensions");
            json* draco = extensions == nullptr ? nullptr : member(*extensions, "KHR_draco_mesh_compression");
            json* view = draco == nullptr ? nullptr : member(*draco, "bufferView");
            if (view == nullptr || indices == nullptr || !indices->is_number_unsigned())
                continue;
            const size_t accessor = indices->get<size_t>();
            if (accessor < accessors->size() && !(*accessors)[accessor].contains("bufferView"))
                (*accessors)[accessor]["bufferView"] = *view;
        }
    }
}

/// Lets tinygltf take buffers that are read already: their URI is their number.
struct LoadedBuffers
{
    std::vector<Bytes> buffers;

    static bool exists(const std::string&, void*) { return true; }
    static std::string expand(const std::string& path, void*) { return path; }
    static bool read(Bytes* out, std::string*, const std::string& path, void* user)
    {
        auto& buffers = static_cast<LoadedBuffers*>(user)->buffers;
        *out = std::move(buffers.at(std::stoul(path.substr(path.find_last_of('/') + 1))));
        return true;
    }
};

Result<LoadedBuffers> takeBuffers(json& document, const std::optional<ByteView>& bin,
                                  const std::filesystem::path& folder, Warnings& warnings)
{
    LoadedBuffers loaded;
    if (!document.contains("buffers"))
        return loaded;
    json& list = document["buffers"];
    for (size_t i = 0; i < list.size(); ++i)
    {
        Result<Bytes> bytes = readBuffer(list[i], i, bin, folder);
        if (!bytes && bytes.error().code == ExitCode::kUnsupported)
            return bytes.error();
        if (!bytes)
        {
            const std::string pointer = fmt::format("/buffers/{}", i);
            std::string message = withoutFolder(bytes.error().message, folder);
            if (const size_t place = message.rfind(fmt::format(" ({}", pointer)); place != std::string::npos)
                message.resize(place);
            warnings.push_back(
                {WarningKind::kUnreadable, pointer, message, "what lies in it is left out", bytes.error().code});
            bytes = Bytes(1);
            list[i]["byteLength"] = 1;
        }
        loaded.buffers.push_back(std::move(*bytes));
        list[i]["uri"] = std::to_string(i);
    }
    return loaded;
}

Status parseModel(const json& document, LoadedBuffers& buffers, tinygltf::Model& model)
{
    std::string error;
    std::string warning;
    bool ok = false;
    try
    {
        const std::string text = document.dump();
        tinygltf::TinyGLTF loader;
        loader.SetFsCallbacks(
            {&LoadedBuffers::exists, &LoadedBuffers::expand, &LoadedBuffers::read, nullptr, &buffers});
        ok = loader.LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "buffers");
    }
    catch (const std::bad_alloc&)
    {
        throw;
    }
    catch (const std::exception& e)
    {
        error = e.what();
    }
    if (ok)
        return Success{};
    std::replace(error.begin(), error.end(), '\n', ' ');
    while (!error.empty() && error.back() == ' ')
        error.pop_back();
    return Error{ExitCode::kInvalid, fmt::format("it is no valid glTF: {}", error.empty() ? "unknown reason" : error)};
}
} // namespace

Result<Bytes> readFile(const std::filesystem::path& path)
{
    std::error_code status;
    const bool regular = std::filesystem::is_regular_file(path, status);
    if (status)
        return Error{ExitCode::kIo, fmt::format("\"{}\" cannot be read: {}", path.string(), status.message())};
    if (!regular)
        return Error{ExitCode::kIo, fmt::format("\"{}\" is not a regular file", path.string())};
    std::ifstream stream(path, std::ios::binary | std::ios::ate);
    if (!stream)
        return Error{ExitCode::kIo, fmt::format("\"{}\" cannot be opened: {}", path.string(), std::strerror(errno))};
    Bytes bytes(size_t(stream.tellg()));
    stream.seekg(0);
    if (!stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size())))
        return Error{ExitCode::kIo, fmt::format("\"{}\" cannot be read to its end", path.string())};
    return bytes;
}

std::string withoutFolder(std::string message, const std::filesystem::path& folder)
{
    const std::string prefix = "\"" + (folder / "").string();
    for (size_t at; prefix.size() > 1 && (at = message.find(prefix)) != std::string::npos;)
        message.erase(at + 1, prefix.size() - 1);
    return message;
}

Result<GltfFile> readGltf(const std::filesystem::path& path)
{
    const Result<Bytes> bytes = readFile(path);
    if (!bytes)
        return bytes.error();
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    Result<Container> container = Container{text, std::nullopt};
    if (text.starts_with("glTF"))
        container = splitGlb(*bytes);
    if (!container)
        return container.error();
    if (text.empty())
        return Error{ExitCode::kInvalid, "the file is empty"};

    Result<json> document = parseJson(container->json);
    if (!document)
        return document.error();
    if (const Status status = checkVersion(*document); !status)
        return status.error();

    GltfFile file;
    file.folder = path.parent_path();
    repairGltf(*document, file.warnings);
    if (const Status status = checkExtensions(*document, file.warnings); !status)
        return status.error();
    if (document->contains("animations") || document->contains("skins"))
        file.warnings.push_back({WarningKind::kLeftOut, "",
                                 "animations and skins are not played: the scene is compiled in its rest pose", ""});
    document->erase("animations");
    document->erase("skins");

    Result<LoadedBuffers> buffers = takeBuffers(*document, container->bin, file.folder, file.warnings);
    if (!buffers)
        return buffers.error();
    Result<std::vector<GltfImage>> images = takeImages(*document);
    if (!images)
        return images.error();
    file.images = std::move(*images);
    lendDracoViews(*document);
    if (const Status status = parseModel(*document, *buffers, file.model); !status)
        return status.error();
    return file;
}
