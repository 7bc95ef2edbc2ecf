#include "compiler/gltf_buffers.h"

#include "compiler/gltf_file.h"
#include "compiler/gltf_meshopt.h"
#include "compiler/parallel.h"

#include <fmt/format.h>

#include <optional>

using nlohmann::json;
using Bytes = std::vector<unsigned char>;

namespace
{
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

/// Whether nothing but the views that `compressed` lists needs each of `count` buffers.
std::vector<bool> standInBuffers(const json& document, const std::vector<MeshoptView>& compressed, size_t count)
{
    std::vector<bool> stand_in(count, false);
    std::vector<bool> is_compressed;
    const auto views = document.find("bufferViews");
    if (views == document.end())
        return stand_in;
    is_compressed.resize(views->size());
    for (const MeshoptView& view : compressed)
        is_compressed[view.view] = true;
    const auto mark = [&](bool value)
    {
        for (size_t i = 0; i < views->size(); ++i)
            if (const auto buffer = (*views)[i].find("buffer");
                is_compressed[i] == value && buffer != (*views)[i].end() && buffer->is_number_unsigned() &&
                buffer->get<size_t>() < count)
                stand_in[buffer->get<size_t>()] = value;
    };
    mark(true);
    mark(false);
    for (const MeshoptView& view : compressed)
        if (view.buffer < count)
            stand_in[view.buffer] = false;
    return stand_in;
}

/// Decodes `views`; what cannot be decoded for want of support is left to the buffer that stands in for it.
Status decodeViews(json& document, const std::vector<MeshoptView>& views, std::vector<Bytes>& buffers,
                   const std::vector<bool>& stand_in, const std::filesystem::path& folder)
{
    size_t loaded = 0;
    size_t decoded = 0;
    for (const Bytes& buffer : buffers)
        loaded += buffer.size();
    for (const MeshoptView& view : views)
    {
        if (view.buffer >= buffers.size())
            return Error{ExitCode::kInvalid,
                         fmt::format("buffer {} does not exist (/bufferViews/{})", view.buffer, view.view)};
        decoded += view.count * view.stride;
        if (decoded > kMeshoptMostRatio * loaded) // several views of one stream
            return Error{ExitCode::kInvalid, fmt::format("its meshopt-compressed buffer views give more than {} times "
                                                         "the bytes that are there (/bufferViews/{})",
                                                         kMeshoptMostRatio, view.view)};
    }
    std::vector<std::optional<Result<Bytes>>> results(views.size());
    parallelFor(views.size(), [&](size_t i) { results[i] = decodeMeshopt(views[i], buffers[views[i].buffer]); });
    for (size_t i = 0; i < views.size(); ++i)
    {
        Result<Bytes>& result = *results[i];
        json& view = document["bufferViews"][views[i].view];
        view.erase("extensions");
        if (result && result->empty())
            return Error{ExitCode::kInvalid, fmt::format("a buffer view is empty (/bufferViews/{})", views[i].view)};
        if (result)
        {
            view["buffer"] = buffers.size();
            view["byteOffset"] = 0;
            document["buffers"].push_back({{"byteLength", result->size()}});
            buffers.push_back(std::move(*result));
            continue;
        }
        const auto buffer = view.find("buffer");
        const bool names_one = buffer != view.end() && buffer->is_number_unsigned();
        const size_t number = names_one ? buffer->get<size_t>() : stand_in.size();
        if (result.error().code != ExitCode::kUnsupported || number >= stand_in.size() ||
            (buffers[number].empty() && !document["buffers"][number].contains("uri")))
            return result.error();
        if (!buffers[number].empty())
            continue;
        Result<Bytes> uncompressed = readBuffer(document["buffers"][number], number, std::nullopt, folder);
        if (!uncompressed)
            return uncompressed.error();
        buffers[number] = std::move(*uncompressed);
    }
    return Success{};
}
} // namespace

Result<std::vector<Bytes>> loadBuffers(GltfDocument& document, const std::filesystem::path& folder)
{
    std::vector<Bytes> buffers;
    if (!document.json.contains("buffers"))
        return buffers;
    const Result<std::vector<MeshoptView>> compressed = findMeshoptViews(document.json);
    if (!compressed)
        return compressed.error();
    json& list = document.json["buffers"];
    const std::vector<bool> stand_in = standInBuffers(document.json, *compressed, list.size());
    for (size_t i = 0; i < list.size(); ++i)
    {
        Result<Bytes> bytes = Bytes();
        if (!stand_in[i])
            bytes = readBuffer(list[i], i, document.bin, folder);
        if (!bytes)
            return bytes.error();
        buffers.push_back(std::move(*bytes));
    }
    if (const Status status = decodeViews(document.json, *compressed, buffers, stand_in, folder); !status)
        return status.error();
    for (size_t i = 0; i < buffers.size(); ++i)
    {
        if (buffers[i].empty())
            buffers[i].resize(1);
        list[i]["byteLength"] = buffers[i].size();
        list[i]["uri"] = std::to_string(i);
    }
    return buffers;
}
