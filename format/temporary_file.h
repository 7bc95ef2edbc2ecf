// A file that appears under its name only once it is whole.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

enum class Durability
{
    kOnDisk,        // whole under its name, or not there, even after a power cut
    kUntilPowerCut, // after one it may hold anything: for files that can be checked and made again
};

/// Written beside `target` and renamed to it by commit(); removed again where that never comes. errno tells why a call
/// failed.
class TemporaryFile
{
public:
    explicit TemporaryFile(const std::filesystem::path& target);
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile();

    bool isOpen() const { return descriptor_ >= 0; }
    uint64_t position() const { return position_; }

    bool append(std::span<const std::byte> bytes);

    /// Puts everything on disk, then the file under its name, replacing what was there.
    bool commit(Durability durability = Durability::kOnDisk);

private:
    std::filesystem::path target_;
    std::filesystem::path path_;
    int descriptor_ = -1;
    uint64_t position_ = 0;
    bool committed_ = false;
};

/// From here on SIGINT, SIGTERM and SIGHUP remove all temporary files that are open, then end the program as ever.
void removeTemporaryFilesOnSignals();

/// Removes all that are open, for a program that ends without cleaning up. May be called by a signal's handler.
void removeOpenTemporaryFiles();
