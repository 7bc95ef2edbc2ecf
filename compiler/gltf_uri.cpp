#include "compiler/gltf_uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>

using Bytes = std::vector<unsigned char>;

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
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1; // - and _ in the alphabet for URLs
}

bool isSpace(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

Result<Bytes> decodeBase64(std::string_view text)
{
    Bytes bytes;
    bytes.reserve(text.size() / 4 * 3);
    uint32_t bits = 0;
    int count = 0;
    while (!text.empty() && (text.back() == '=' || isSpace(text.back())))
        text.remove_suffix(1);
    for (const char c : text)
    {
        if (isSpace(c))
            continue;
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
char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
}

std::string lower(std::string_view text)
{
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](char c) { return lower(c); });
    return out;
}

bool startsWith(std::string_view text, std::string_view lower_case)
{
    return lower(text.substr(0, lower_case.size())) == lower_case;
}

/// data:[type][;parameter=value...][;base64],data
Result<Bytes> readDataUri(std::string_view uri)
{
    const size_t comma = uri.find(',');
    if (comma == std::string_view::npos)
        return Error{ExitCode::kInvalid, "a data URI has no data: it lacks a comma"};
    std::string header = lower(uri.substr(0, comma));
    header.erase(std::remove_if(header.begin(), header.end(), isSpace), header.end());
    std::string_view data = uri.substr(comma + 1);
    if (header.ends_with(";base64") && data.find('%') == std::string_view::npos)
        return decodeBase64(data);
    const std::string plain = decodePercent(data);
    if (header.ends_with(";base64"))
        return decodeBase64(plain);
    return Error{ExitCode::kInvalid, "a data URI is not base64-encoded"};
}

/// The path of a file: URI, or nothing where it names another machine.
std::optional<std::string> fileUriPath(std::string_view uri)
{
    std::string_view rest = uri.substr(std::string_view("file:").size());
    if (!rest.starts_with("//"))
        return std::string(rest);
    rest.remove_prefix(2);
    const size_t slash = rest.find('/');
    const std::string host = lower(rest.substr(0, slash));
    if (slash == std::string_view::npos || (!host.empty() && host != "localhost"))
        return std::nullopt;
    return std::string(rest.substr(slash));
}

/// Names of files that `uri` may stand for, the likeliest first.
std::vector<std::string> fileNames(const std::string& uri)
{
    std::vector<std::string> names;
    const auto add = [&](std::string name)
    {
        if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
            names.push_back(std::move(name));
    };
    const auto addSpellings = [&](const std::string& text)
    {
        for (const std::string& name : {decodePercent(text), text})
        {
            std::string slashes = name;
            std::replace(slashes.begin(), slashes.end(), '\\', '/');
            add(slashes);
            add(name);
        }
    };
    addSpellings(uri);
    addSpellings(uri.substr(0, uri.find_first_of("?#")));
    return names;
}

/// The name of a file below `folder` that is `name` but for its case, if one file alone has it. @param name relative
std::optional<std::string> findInAnyCase(const std::filesystem::path& folder, const std::filesystem::path& name)
{
    const std::filesystem::path start = folder.empty() ? std::filesystem::path(".") : folder;
    std::filesystem::path found = start;
    for (const std::filesystem::path& part : name.lexically_normal())
    {
        std::error_code error;
        if (std::filesystem::exists(found / part, error))
        {
            found /= part;
            continue;
        }
        std::vector<std::filesystem::path> matches;
        for (std::filesystem::directory_iterator entry(found, error), end; !error && entry != end;
             entry.increment(error))
            if (lower(entry->path().filename().string()) == lower(part.string()))
                matches.push_back(entry->path());
        if (error || matches.size() != 1)
            return std::nullopt;
        found = matches[0];
    }
    return found.lexically_relative(start).string();
}
} // namespace

bool isDataUri(std::string_view uri)
{
    return startsWith(uri, "data:");
}

Result<Bytes> readUri(const std::string& uri, InputFiles& files)
{
    if (isDataUri(uri))
        return readDataUri(uri);
    const auto elsewhere = [&]
    {
        return Error{ExitCode::kUnsupported,
                     fmt::format("\"{}\" is not a local file; download it beside the scene", uri.substr(0, 200))};
    };
    std::string local = uri;
    if (startsWith(uri, "file:"))
    {
        const std::optional<std::string> path = fileUriPath(uri);
        if (!path)
            return elsewhere();
        local = *path;
    }
    else if (uri.find("://") != std::string::npos)
        return elsewhere();
    const std::vector<std::string> names = fileNames(local);
    if (names.empty() || names[0].find('\0') != std::string::npos)
        return Error{ExitCode::kInvalid, "a URI is empty or holds a zero character"};
    std::error_code error;
    for (const std::string& name : names)
        if (std::filesystem::is_regular_file(files.folder() / name, error))
            return files.read(name);
    for (const std::string& name : names)
        if (const std::filesystem::path path = name; path.is_relative())
            if (const auto found = findInAnyCase(files.folder(), path))
                return files.read(*found);
    return files.read(names[0]);
}

std::string withoutFolder(std::string message, const std::filesystem::path& folder)
{
    const std::string prefix = fmt::format("\"{}", (folder / "").string());
    for (size_t at; prefix.size() > 1 && (at = message.find(prefix)) != std::string::npos;)
        message.erase(at + 1, prefix.size() - 1);
    return message;
}

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
