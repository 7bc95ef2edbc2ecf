#include "format/temporary_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <utility>

namespace
{
/// A file that a signal is to remove. A handler may neither lock nor allocate: fixed places, taken and given back by
/// one atomic step.
struct OpenFile
{
    enum State : int
    {
        kFree,
        kTaken,
        kOpen
    };
    std::atomic<int> state{kFree};
    std::array<char, PATH_MAX> path{};
};
std::array<OpenFile, 64> open_files;

/// Where all places are taken the file is left to chance: a signal then leaves it behind.
void rememberOpen(const char* path)
{
    const size_t bytes = std::strlen(path) + 1;
    for (OpenFile& file : open_files)
    {
        int expected = OpenFile::kFree;
        if (bytes > file.path.size() || !file.state.compare_exchange_strong(expected, OpenFile::kTaken))
            continue;
        std::memcpy(file.path.data(), path, bytes);
        file.state = OpenFile::kOpen;
        return;
    }
}

void forgetOpen(const char* path)
{
    for (OpenFile& file : open_files)
        if (file.state == OpenFile::kOpen && std::strcmp(file.path.data(), path) == 0)
            file.state = OpenFile::kFree;
}

void removeOpenFilesAndEnd(int signal)
{
    removeOpenTemporaryFiles();
    raise(signal); // the handler is in force once only, so that this one ends the program
}
} // namespace

void removeOpenTemporaryFiles()
{
    for (OpenFile& file : open_files)
        if (file.state == OpenFile::kOpen)
            unlink(file.path.data());
}

void removeTemporaryFilesOnSignals()
{
    struct sigaction action = {};
    action.sa_handler = removeOpenFilesAndEnd;
    action.sa_flags = int(SA_RESETHAND | SA_NODEFER);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    {
        struct sigaction before = {};
        if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) // nohup and the like ask for that
            sigaction(signal, &action, nullptr);
    }
}

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
    if (descriptor_ >= 0)
        rememberOpen(path_.c_str());
    else
        path_.clear(); // there is nothing to remove
}

TemporaryFile::~TemporaryFile()
{
    if (path_.empty())
        return;
    if (descriptor_ >= 0)
        close(descriptor_);
    if (!committed_)
        unlink(path_.c_str());
    forgetOpen(path_.c_str());
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

bool TemporaryFile::commit(Durability durability)
{
    const bool on_disk = durability == Durability::kOnDisk;
    if (on_disk && fsync(descriptor_) != 0)
        return false;
    if (close(std::exchange(descriptor_, -1)) != 0) // a share may tell only now that its disk is full
        return false;
    if (rename(path_.c_str(), target_.c_str()) != 0)
        return false;
    committed_ = true;
    if (!on_disk)
        return true;
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
