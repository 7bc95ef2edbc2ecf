#include "compiler/gltf_meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <optional>
#include <string_view>

using nlohmann::json;
using Bytes = std::vector<unsigned char>;

namespace
{
/// Names the field of the view's extension, as all its errors do.
class Description
{
public:
    Description(const json& extension, const char* name, size_t view) : extension_(extension), name_(name), view_(view)
    {
    }

    Error invalid(std::string_view text) const
    {
        return {ExitCode::kInvalid, fmt::format("{} (/bufferViews/{}/extensions/{})", text, view_, name_)};
    }

    /// A whole number, or `fallback` where it is absent and there is one.
    Result<size_t> number(const char* key, std::optional<size_t> fallback = std::nullopt) const
    {
        const auto value = extension_.find(key);
        if (value == extension_.end() && fallback)
            return *fallback;
        if (value == extension_.end() || !value->is_number_unsigned())
            return invalid(fmt::format("a meshopt-compressed buffer view has no valid {}", key));
        return value->get<size_t>();
    }

    Result<std::string> text(const char* key, const char* fallback) const
    {
        const auto value = extension_.find(key);
        if (value == extension_.end() && fallback != nullptr)
            return std::string(fallback);
        if (value == extension_.end() || !value->is_string())
            return invalid(fmt::format("a meshopt-compressed buffer view has no valid {}", key));
        return value->get<std::string>();
    }

private:
    const json& extension_;
    const char* name_;
    size_t view_;
};

std::optional<MeshoptMode> modeOf(std::string_view name)
{
    if (name == "ATTRIBUTES")
        return MeshoptMode::kAttributes;
    if (name == "TRIANGLES")
        return MeshoptMode::kTriangles;
    if (name == "INDICES")
        return MeshoptMode::kIndices;
    return std::nullopt;
}

std::optional<MeshoptFilter> filterOf(std::string_view name)
{
    if (name == "NONE")
        return MeshoptFilter::kNone;
    if (name == "OCTAHEDRAL")
        return MeshoptFilter::kOctahedral;
    if (name == "QUATERNION")
        return MeshoptFilter::kQuaternion;
    if (name == "EXPONENTIAL")
        return MeshoptFilter::kExponential;
    if (name == "COLOR")
        return MeshoptFilter::kColor;
    return std::nullopt;
}

/// The library asserts these.
bool isStrideOf(MeshoptMode mode, MeshoptFilter filter, size_t stride)
{
    if (mode != MeshoptMode::kAttributes)
        return stride == 2 || stride == 4;
    if (stride == 0 || stride > 256 || stride % 4 != 0)
        return false;
    return filter == MeshoptFilter::kOctahedral || filter == MeshoptFilter::kColor ? stride == 4 || stride == 8
           : filter == MeshoptFilter::kQuaternion                                  ? stride == 8
                                                                                   : true;
}

/// The least bytes of a stream of `count` elements: what the codecs spend on data of which nothing needs to be said.
/// Checked before there is memory for the elements, so that a small file cannot ask for much of it.
size_t leastBytes(const MeshoptView& view)
{
    if (view.mode == MeshoptMode::kTriangles)
        return 1 + view.count / 3 + 16; // header, a byte a triangle, table at the end
    if (view.mode == MeshoptMode::kIndices)
        return 1 + view.count + 4; // header, a byte an index, padding
    const size_t block = std::min<size_t>(8192 / view.stride / 16 * 16, 256);
    const auto block_bytes = [&](size_t vertices) // two bits for every 16 vertices, for each byte of a vertex
    { return view.stride * ((vertices + 63) / 64); };
    return 1 + view.count / block * block_bytes(block) + block_bytes(view.count % block) +
           std::max<size_t>(view.stride, 32);
}

Result<MeshoptView> readView(const json& extension, const char* name, size_t index, const json& buffer_view)
{
    const Description from(extension, name, index);
    const auto buffer = from.number("buffer");
    const auto offset = from.number("byteOffset", 0);
    const auto bytes = from.number("byteLength");
    const auto stride = from.number("byteStride");
    const auto count = from.number("count");
    for (const auto* number : {&buffer, &offset, &bytes, &stride, &count})
        if (!*number)
            return number->error();
    const auto mode_name = from.text("mode", nullptr);
    const auto filter_name = from.text("filter", "NONE");
    if (!mode_name || !filter_name)
        return mode_name ? filter_name.error() : mode_name.error();
    const auto mode = modeOf(*mode_name);
    const auto filter = filterOf(*filter_name);
    if (!mode || !filter || (*mode != MeshoptMode::kAttributes && *filter != MeshoptFilter::kNone))
        return from.invalid(fmt::format("meshopt mode \"{}\" with filter \"{}\" does not exist",
                                        mode_name->substr(0, 40), filter_name->substr(0, 40)));
    if (!isStrideOf(*mode, *filter, *stride))
        return from.invalid(fmt::format("a stride of {} bytes does not suit meshopt mode {} with filter {}", *stride,
                                        *mode_name, *filter_name));
    if (*mode == MeshoptMode::kTriangles && *count % 3 != 0)
        return from.invalid(fmt::format("{} indices are no whole number of triangles", *count));
    if (*count > kMeshoptMostRatio * std::min(*bytes, size_t(1) << 40)) // so that their product is a number
        return from.invalid(fmt::format("{} elements cannot lie in {} bytes", *count, *bytes));
    const auto length = buffer_view.find("byteLength");
    if (length == buffer_view.end() || !length->is_number_unsigned() || length->get<size_t>() != *count * *stride)
        return from.invalid(
            fmt::format("{} elements of {} bytes do not fill their buffer view exactly", *count, *stride));
    return MeshoptView{index, *buffer, *offset, *bytes, *count, *stride, *mode, *filter};
}

/// The first byte of a stream: the codec in its high half, the version in its low half.
struct Codec
{
    unsigned char header;
    unsigned char newest;
    const char* name;
};

Codec codecOf(MeshoptMode mode)
{
    return mode == MeshoptMode::kAttributes  ? Codec{0xa0, 0, "vertex"}
           : mode == MeshoptMode::kTriangles ? Codec{0xe0, 1, "triangle"}
                                             : Codec{0xd0, 1, "index"};
}

int decodeStream(const MeshoptView& view, const unsigned char* stream, Bytes& out)
{
    switch (view.mode)
    {
    case MeshoptMode::kAttributes:
        return meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, stream, view.bytes);
    case MeshoptMode::kTriangles:
        return meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, stream, view.bytes);
    default:
        return meshopt_decodeIndexSequence(out.data(), view.count, view.stride, stream, view.bytes);
    }
}

void applyFilter(const MeshoptView& view, Bytes& data)
{
    if (view.filter == MeshoptFilter::kOctahedral)
        meshopt_decodeFilterOct(data.data(), view.count, view.stride);
    else if (view.filter == MeshoptFilter::kQuaternion)
        meshopt_decodeFilterQuat(data.data(), view.count, view.stride);
    else if (view.filter == MeshoptFilter::kExponential)
        meshopt_decodeFilterExp(data.data(), view.count, view.stride);
}
} // namespace

std::vector<MeshoptView> findMeshoptViews(const json& document, Warnings& warnings)
{
    std::vector<MeshoptView> views;
    const auto list = document.find("bufferViews");
    if (list == document.end())
        return views;
    for (size_t i = 0; i < list->size(); ++i)
    {
        const auto extensions = (*list)[i].find("extensions");
        if (extensions == (*list)[i].end() || !extensions->is_object())
            continue;
        for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        {
            const auto extension = extensions->find(name);
            if (extension == extensions->end())
                continue;
            const Result<MeshoptView> view = extension->is_object()
                                                 ? readView(*extension, name, i, (*list)[i])
                                                 : Description(*extension, name, i).invalid("an object is expected");
            if (view)
                views.push_back(*view);
            else
                warnings.push_back(warningOf(WarningKind::kMalformed, view.error(), fmt::format("/bufferViews/{}", i),
                                             "it is taken as not compressed"));
            break;
        }
    }
    return views;
}

Result<Bytes> decodeMeshopt(const MeshoptView& view, const Bytes& buffer)
{
    const auto error = [&](ExitCode code, std::string_view text) {
        return Error{code, fmt::format("{} (/bufferViews/{})", text, view.view)};
    };
    if (view.offset > buffer.size() || view.bytes > buffer.size() - view.offset || view.bytes == 0)
        return error(ExitCode::kInvalid, "meshopt-compressed data reaches past the end of its buffer");
    const unsigned char* stream = buffer.data() + view.offset;
    const Codec codec = codecOf(view.mode);
    if ((stream[0] & 0xf0) != codec.header)
        return error(ExitCode::kInvalid, fmt::format("meshopt-compressed data is damaged: it does not start as a "
                                                     "stream of the {} codec does",
                                                     codec.name));
    if ((stream[0] & 0x0f) > codec.newest)
        return error(ExitCode::kUnsupported,
                     fmt::format("its geometry is compressed with version {} of meshopt's {} codec, which is not "
                                 "supported; compress it with EXT_meshopt_compression, which has version {}",
                                 stream[0] & 0x0f, codec.name, codec.newest));
    if (view.filter == MeshoptFilter::kColor)
        return error(ExitCode::kUnsupported, "its geometry is compressed with meshopt's colour filter, which is not "
                                             "supported; compress it with EXT_meshopt_compression");
    if (view.bytes < leastBytes(view))
        return error(ExitCode::kInvalid, fmt::format("{} elements of meshopt-compressed data cannot lie in {} bytes",
                                                     view.count, view.bytes));
    Bytes data(view.count * view.stride);
    if (const int failure = decodeStream(view, stream, data); failure != 0)
        return error(ExitCode::kInvalid, "meshopt-compressed data is damaged");
    applyFilter(view, data);
    return data;
}
