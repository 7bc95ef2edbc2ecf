#include "format/temporary_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>

TemporaryFile::TemporaryFile(const std::filesystem::path& target) : target_(target)
{
    for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt)
    {
        path_ = target;
        path_ += fmt::format(".{}-{}.tmp", getpid(), attempt);
        descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ < 0 && errno != EEXIST)
            break;
    }
}

TemporaryFile::~TemporaryFile()
{
    if (descriptor_ < 0)
        return;
    close(descriptor_);
    if (!committed_)
        unlink(path_.c_str());
}

bool TemporaryFile::append(std::span<const std::byte> bytes)
{
    while (!bytes.empty())
    {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return false;
        position_ += uint64_t(written);
        bytes = bytes.subspan(size_t(written));
    }
    return true;
}

bool TemporaryFile::commit()
{
    if (fsync(descriptor_) != 0 || rename(path_.c_str(), target_.c_str()) != 0)
        return false;
    committed_ = true;
    // The name itself survives a power cut only once its folder is on disk; some file systems refuse, harmlessly.
    const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
    const int folder_descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder_descriptor >= 0)
    {
        fsync(folder_descriptor);
        close(folder_descriptor);
    }
    return true;
}
