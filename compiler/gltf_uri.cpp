#include "compiler/gltf_file.h"

#include <fmt/format.h>

namespace
{
int base64Value(char c)
{
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26;
    if (c >= '0' && c <= '9')
        return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

Result<std::vector<unsigned char>> decodeBase64(std::string_view text)
{
    std::vector<unsigned char> bytes;
    bytes.reserve(text.size() / 4 * 3);
    uint32_t bits = 0;
    int count = 0;
    while (!text.empty() && text.back() == '=')
        text.remove_suffix(1);
    for (const char c : text)
    {
        const int value = base64Value(c);
        if (value < 0)
            return Error{ExitCode::kInvalid, "a data URI holds a character that is not base64"};
        bits = bits << 6 | uint32_t(value);
        count += 6;
        if (count >= 8)
        {
            count -= 8;
            bytes.push_back(static_cast<unsigned char>(bits >> count & 0xffu));
        }
    }
    return bytes;
}

std::string decodePercent(std::string_view text)
{
    const auto hex = [](char c)
    {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    std::string out;
    for (size_t i = 0; i < text.size(); ++i)
    {
        if (text[i] == '%' && i + 2 < text.size() && hex(text[i + 1]) >= 0 && hex(text[i + 2]) >= 0)
        {
            out.push_back(char(hex(text[i + 1]) * 16 + hex(text[i + 2])));
            i += 2;
        }
        else
            out.push_back(text[i]);
    }
    return out;
}
} // namespace

Result<std::vector<unsigned char>> readUri(const std::string& uri, InputFiles& files)
{
    if (uri.starts_with("data:"))
    {
        const size_t comma = uri.find(',');
        if (comma == std::string::npos || uri.rfind(";base64", comma) == std::string::npos)
            return Error{ExitCode::kInvalid, "a data URI is not base64-encoded"};
        return decodeBase64(std::string_view(uri).substr(comma + 1));
    }
    if (const size_t scheme = uri.find("://"); scheme != std::string::npos)
        return Error{ExitCode::kUnsupported,
                     fmt::format("\"{}\" is not a local file; download it beside the scene", uri.substr(0, 200))};
    const std::string name = decodePercent(uri);
    if (name.empty() || name.find('\0') != std::string::npos)
        return Error{ExitCode::kInvalid, "a URI is empty or holds a zero character"};
    return files.read(name);
}

Result<ByteView> viewBytes(const tinygltf::Model& model, int buffer_view)
{
    if (buffer_view < 0 || size_t(buffer_view) >= model.bufferViews.size())
        return Error{ExitCode::kInvalid, fmt::format("buffer view {} does not exist", buffer_view)};
    const tinygltf::BufferView& view = model.bufferViews[size_t(buffer_view)];
    if (view.buffer < 0 || size_t(view.buffer) >= model.buffers.size())
        return Error{ExitCode::kInvalid,
                     fmt::format("buffer {} does not exist (/bufferViews/{}/buffer)", view.buffer, buffer_view)};
    const auto& data = model.buffers[size_t(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
        return Error{ExitCode::kInvalid,
                     fmt::format("a buffer view reaches past the end of its buffer (/bufferViews/{})", buffer_view)};
    return ByteView{data.data() + view.byteOffset, view.byteLength, view.byteStride};
}
