#include "tools/pkg/archive.h"

#include "format/mapped_file.h"
#include "format/temporary_file.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <set>

namespace
{
constexpr time_t kTime = 315532800; // 1980-01-01: the same for all, and no tool finds it implausible

struct ArchiveRelease
{
    void operator()(archive* a) const { archive_write_free(a); }
};
struct EntryRelease
{
    void operator()(archive_entry* e) const { archive_entry_free(e); }
};
using Archive = std::unique_ptr<archive, ArchiveRelease>;
using Entry = std::unique_ptr<archive_entry, EntryRelease>;

/// An entry's bytes and their storage.
struct Content
{
    package::MappedFile file;
    std::span<const std::byte> bytes;
};

Result<Content> load(const ArchiveEntry& entry)
{
    Content content;
    if (const auto* text = std::get_if<std::string>(&entry.content))
    {
        content.bytes = std::as_bytes(std::span(*text));
        return content;
    }
    const auto& path = std::get<std::filesystem::path>(entry.content);
    auto file = package::MappedFile::open(path);
    if (!file)
        return Error{ExitCode::kIo, fmt::format("{} cannot be read: {}", path.string(), file.error().message)};
    content.file = std::move(*file);
    content.bytes = content.file.bytes();
    return content;
}

la_ssize_t append(archive*, void* file, const void* data, size_t size)
{
    return static_cast<TemporaryFile*>(file)->append({static_cast<const std::byte*>(data), size}) ? la_ssize_t(size)
                                                                                                  : -1;
}

Error archiveError(archive* a)
{
    const char* reason = archive_error_string(a);
    return {ExitCode::kIo, fmt::format("cannot write the archive: {}", reason ? reason : std::strerror(errno))};
}

Status writeEntry(archive* a, const std::string& path, mode_t type, mode_t mode, std::span<const std::byte> bytes)
{
    const Entry entry(archive_entry_new());
    archive_entry_set_pathname(entry.get(), path.c_str());
    archive_entry_set_filetype(entry.get(), type);
    archive_entry_set_perm(entry.get(), mode);
    archive_entry_set_size(entry.get(), la_int64_t(bytes.size()));
    archive_entry_set_mtime(entry.get(), kTime, 0);
    archive_entry_set_uid(entry.get(), 0);
    archive_entry_set_gid(entry.get(), 0);
    if (archive_write_header(a, entry.get()) != ARCHIVE_OK)
        return archiveError(a);
    if (archive_write_data(a, bytes.data(), bytes.size()) != la_ssize_t(bytes.size()))
        return archiveError(a);
    return Success{};
}

Status writeEntries(archive* a, const std::string& root, const ArchiveEntries& entries)
{
    std::set<std::string> folders{root};
    if (Status status = writeEntry(a, root, AE_IFDIR, 0755, {}); !status)
        return status;
    for (const auto& [path, entry] : entries)
    {
        const std::string full = root + "/" + path;
        for (size_t slash = full.find('/'); slash != std::string::npos; slash = full.find('/', slash + 1))
        {
            const std::string folder = full.substr(0, slash);
            if (!folders.insert(folder).second)
                continue;
            if (Status status = writeEntry(a, folder, AE_IFDIR, 0755, {}); !status)
                return status;
        }
        const Result<Content> content = load(entry);
        if (!content)
            return content.error();
        if (Status status = writeEntry(a, full, AE_IFREG, entry.executable ? 0755 : 0644, content->bytes); !status)
            return status;
    }
    return Success{};
}
} // namespace

Result<Digest> digest(const ArchiveEntry& entry)
{
    const Result<Content> content = load(entry);
    if (!content)
        return content.error();
    std::array<unsigned char, EVP_MAX_MD_SIZE> hash;
    unsigned size = 0;
    if (EVP_Digest(content->bytes.data(), content->bytes.size(), hash.data(), &size, EVP_sha256(), nullptr) != 1)
        return Error{ExitCode::kDevice, "SHA-256 is not available from this machine's libcrypto"};
    Digest result{.bytes = content->bytes.size(), .sha256 = {}};
    for (unsigned i = 0; i < size; ++i)
        result.sha256 += fmt::format("{:02x}", hash[i]);
    return result;
}

Status writeArchive(const std::filesystem::path& output, const std::string& root, const ArchiveEntries& entries)
{
    TemporaryFile file(output);
    if (!file.isOpen())
        return Error{ExitCode::kIo, fmt::format("cannot create the archive: {}", std::strerror(errno))};
    {
        const Archive a(archive_write_new());
        archive_write_set_format_pax_restricted(a.get());
        archive_write_add_filter_zstd(a.get());
        archive_write_set_filter_option(a.get(), "zstd", "compression-level", "9");
        archive_write_set_bytes_in_last_block(a.get(), 1); // tape padding after the zstd frame is no zstd
        if (archive_write_open(a.get(), &file, nullptr, append, nullptr) != ARCHIVE_OK)
            return archiveError(a.get());
        if (Status status = writeEntries(a.get(), root, entries); !status)
            return status;
        if (archive_write_close(a.get()) != ARCHIVE_OK)
            return archiveError(a.get());
    }
    if (!file.commit())
        return Error{ExitCode::kIo, fmt::format("cannot finish the archive: {}", std::strerror(errno))};
    return Success{};
}
