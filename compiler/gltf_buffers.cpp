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
Result<Bytes> readBuffer(const json& buffer, size_t i, const std::optional<ByteView>& bin, InputFiles& files)
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
    Result<Bytes> data = readUri(uri->get<std::string>(), files);
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

/// A buffer or view that cannot be read.
Warning unreadable(const Error& error, std::string pointer, const InputFiles& files)
{
    Error relative = error;
    relative.message = withoutFolder(std::move(relative.message), files.folder());
    Warning warning = warningOf(WarningKind::kUnreadable, relative, pointer, "what lies in it is left out");
    warning.pointer = std::move(pointer);
    return warning;
}

/// Decodes those `views` that `buffers` hold and that do not give too much.
std::vector<Result<Bytes>> decodeAll(const std::vector<MeshoptView>& views, const std::vector<Bytes>& buffers)
{
    size_t loaded = 0;
    size_t decoded = 0;
    for (const Bytes& buffer : buffers)
        loaded += buffer.size();
    std::vector<Result<Bytes>> results;
    for (const MeshoptView& view : views)
    {
        if (view.buffer >= buffers.size())
        {
            results.push_back(Error{ExitCode::kInvalid, fmt::format("buffer {} does not exist", view.buffer)});
            continue;
        }
        decoded += view.count * view.stride;
        if (decoded > kMeshoptMostRatio * loaded) // several views of one stream
            results.push_back(
                Error{ExitCode::kInvalid, fmt::format("its meshopt-compressed buffer views give more than {} "
                                                      "times the bytes that are there",
                                                      kMeshoptMostRatio)});
        else
            results.push_back(Bytes());
    }
    parallelFor(views.size(),
                [&](size_t i)
                {
                    if (results[i])
                        results[i] = decodeMeshopt(views[i], buffers[views[i].buffer]);
                });
    return results;
}

/// Decodes `views`; what cannot be decoded for want of support is left to the buffer that stands in for it.
Status decodeViews(json& document, const std::vector<MeshoptView>& views, std::vector<Bytes>& buffers,
                   const std::vector<bool>& stand_in, InputFiles& files, Warnings& warnings)
{
    std::vector<Result<Bytes>> results = decodeAll(views, buffers);
    const auto moveTo = [&](json& view, Bytes content)
    {
        view["buffer"] = buffers.size();
        view["byteOffset"] = 0;
        document["buffers"].push_back({{"byteLength", content.size()}});
        buffers.push_back(std::move(content));
    };
    for (size_t i = 0; i < views.size(); ++i)
    {
        Result<Bytes>& result = results[i];
        json& view = document["bufferViews"][views[i].view];
        view.erase("extensions");
        if (result && result->empty())
            result = Error{ExitCode::kInvalid, "a buffer view is empty"};
        if (result)
        {
            moveTo(view, std::move(*result));
            continue;
        }
        if (result.error().code != ExitCode::kUnsupported)
        {
            warnings.push_back(unreadable(result.error(), fmt::format("/bufferViews/{}", views[i].view), files));
            moveTo(view, Bytes(1));
            continue;
        }
        const auto buffer = view.find("buffer");
        const bool names_one = buffer != view.end() && buffer->is_number_unsigned();
        const size_t number = names_one ? buffer->get<size_t>() : stand_in.size();
        if (number >= stand_in.size() || (buffers[number].empty() && !document["buffers"][number].contains("uri")))
            return result.error();
        if (!buffers[number].empty())
            continue;
        Result<Bytes> uncompressed = readBuffer(document["buffers"][number], number, std::nullopt, files);
        if (!uncompressed)
            warnings.push_back(unreadable(uncompressed.error(), fmt::format("/buffers/{}", number), files));
        buffers[number] = uncompressed ? std::move(*uncompressed) : Bytes(1);
    }
    return Success{};
}
} // namespace

Result<std::vector<Bytes>> loadBuffers(GltfDocument& document, InputFiles& files, Warnings& warnings)
{
    std::vector<Bytes> buffers;
    if (!document.json.contains("buffers"))
        return buffers;
    const std::vector<MeshoptView> compressed = findMeshoptViews(document.json, warnings);
    json& list = document.json["buffers"];
    const std::vector<bool> stand_in = standInBuffers(document.json, compressed, list.size());
    for (size_t i = 0; i < list.size(); ++i)
    {
        Result<Bytes> bytes = Bytes();
        if (!stand_in[i])
            bytes = readBuffer(list[i], i, document.bin, files);
        if (!bytes && bytes.error().code == ExitCode::kUnsupported)
            return bytes.error();
        if (!bytes)
        {
            warnings.push_back(unreadable(bytes.error(), fmt::format("/buffers/{}", i), files));
            bytes = Bytes(1);
        }
        buffers.push_back(std::move(*bytes));
    }
    if (const Status status = decodeViews(document.json, compressed, buffers, stand_in, files, warnings); !status)
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
