#include "compiler/input_files.h"

#include "compiler/gltf_file.h"
#include "format/mapped_file.h"

Result<std::vector<unsigned char>> InputFiles::read(const std::string& name)
{
    Result<std::vector<unsigned char>> bytes = readFile(folder_ / name);
    std::optional<ContentHash> content;
    if (bytes)
        content = hashOf(std::as_bytes(std::span(*bytes)));
    const std::lock_guard lock(mutex_);
    read_.insert_or_assign(name, content);
    return bytes;
}

std::vector<InputFile> InputFiles::list() const
{
    const std::lock_guard lock(mutex_);
    std::vector<InputFile> files;
    for (const auto& [name, content] : read_)
        files.push_back({name, content});
    return files;
}

std::optional<ContentHash> contentOf(const std::filesystem::path& path)
{
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        return std::nullopt;
    if (std::filesystem::file_size(path, ignored) == 0) // cannot be mapped
        return hashOf({});
    const Result<package::MappedFile> file = package::MappedFile::open(path);
    if (!file)
        return std::nullopt;
    return hashOf(file->bytes());
}
