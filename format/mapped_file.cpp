#include "format/mapped_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace package
{
namespace
{
struct Descriptor
{
    int fd;
    ~Descriptor() { close(fd); }
};

Error ioError(const char* what)
{
    return {ExitCode::kIo, fmt::format("cannot {}: {}", what, std::strerror(errno))};
}
} // namespace

Result<MappedFile> MappedFile::open(const std::filesystem::path& path)
{
    // O_NONBLOCK: opening a named pipe must fail, not block.
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        return ioError("open the file");
    const Descriptor descriptor{fd};

    struct stat info = {};
    if (fstat(fd, &info) != 0)
        return ioError("read the file's size");
    if (S_ISDIR(info.st_mode))
        return Error{ExitCode::kIo, "this is a directory; name the file itself"};
    if (!S_ISREG(info.st_mode))
        return Error{ExitCode::kIo, "this is not a regular file; it is read by mapping, so copy it to one first"};
    if (info.st_size == 0)
        return Error{ExitCode::kInvalid, "the file is empty (0 bytes); make or copy it again"};

    void* address = mmap(nullptr, size_t(info.st_size), PROT_READ, MAP_PRIVATE, fd, 0);
    if (address == MAP_FAILED)
        return ioError("map the file");
    MappedFile file;
    file.bytes_ = {static_cast<const std::byte*>(address), size_t(info.st_size)};
    return file;
}

MappedFile::MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept
{
    std::swap(bytes_, other.bytes_);
    return *this;
}

MappedFile::~MappedFile()
{
    if (!bytes_.empty())
        munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}
} // namespace package
