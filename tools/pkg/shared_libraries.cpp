#include "tools/pkg/shared_libraries.h"

#include "format/mapped_file.h"
#include "tools/pkg/subprocess.h"

#include <elf.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>
#include <vector>

namespace
{
using Bytes = std::span<const std::byte>;

bool belongsToTheMachine(std::string_view library)
{
    constexpr std::array kFamilies{"ld-linux", "libX",      "libxcb",    "libxkbcommon", "libwayland", "libGL",
                                   "libEGL",   "libOpenGL", "libvulkan", "libdrm",       "libgbm",     "libnvidia"};
    constexpr std::array kRuntime{"libc.so",  "libm.so",      "libdl.so",   "libpthread.so",
                                  "librt.so", "libstdc++.so", "libgcc_s.so"};
    const auto starts = [&](const char* prefix) { return library.starts_with(prefix); };
    return std::any_of(kFamilies.begin(), kFamilies.end(), starts) ||
           std::any_of(kRuntime.begin(), kRuntime.end(), starts);
}

template <typename T>
bool readAt(Bytes file, uint64_t offset, T& out)
{
    if (offset > file.size() || file.size() - offset < sizeof(T))
        return false;
    std::memcpy(&out, file.data() + offset, sizeof(T));
    return true;
}

/// Where a virtual address lies in the file.
uint64_t fileOffset(const std::vector<Elf64_Phdr>& segments, uint64_t address)
{
    for (const Elf64_Phdr& s : segments)
    {
        if (s.p_type == PT_LOAD && address >= s.p_vaddr && address - s.p_vaddr < s.p_filesz)
            return address - s.p_vaddr + s.p_offset;
    }
    return UINT64_MAX;
}

std::vector<Elf64_Phdr> readSegments(Bytes file)
{
    std::vector<Elf64_Phdr> segments;
    Elf64_Ehdr header;
    if (!readAt(file, 0, header) || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 ||
        header.e_ident[EI_CLASS] != ELFCLASS64)
        return segments;
    for (uint64_t i = 0; i < header.e_phnum; ++i)
    {
        Elf64_Phdr segment;
        if (readAt(file, header.e_phoff + i * sizeof(segment), segment))
            segments.push_back(segment);
    }
    return segments;
}

/// The DT_NEEDED entries: the libraries that `path` itself asks for.
Result<std::vector<std::string>> neededBy(const std::filesystem::path& path)
{
    const auto mapped = package::MappedFile::open(path);
    if (!mapped)
        return Error{ExitCode::kIo, fmt::format("{} cannot be read as a program or library", path.string())};
    const Bytes file = mapped->bytes();
    const std::vector<Elf64_Phdr> segments = readSegments(file);
    if (segments.empty())
        return Error{ExitCode::kInvalid, fmt::format("{} is no 64-bit ELF program or library", path.string())};

    std::vector<uint64_t> names;
    uint64_t strings = UINT64_MAX;
    for (const Elf64_Phdr& segment : segments)
    {
        if (segment.p_type != PT_DYNAMIC)
            continue;
        Elf64_Dyn entry;
        for (uint64_t offset = segment.p_offset; readAt(file, offset, entry) && entry.d_tag != DT_NULL;
             offset += sizeof(entry))
        {
            if (entry.d_tag == DT_NEEDED)
                names.push_back(entry.d_un.d_val);
            if (entry.d_tag == DT_STRTAB)
                strings = fileOffset(segments, entry.d_un.d_ptr);
        }
    }
    std::vector<std::string> needed;
    for (const uint64_t name : names)
    {
        if (strings >= file.size() || name >= file.size() - strings)
            return Error{ExitCode::kInvalid, fmt::format("{} has a damaged dynamic section", path.string())};
        const char* begin = reinterpret_cast<const char*>(file.data() + strings + name);
        needed.emplace_back(begin, strnlen(begin, file.size() - strings - name));
    }
    return needed;
}

/// What the loader finds for every library that `program` loads, directly or not.
std::map<std::string, std::filesystem::path> resolvedLibraries(const std::filesystem::path& program)
{
    std::map<std::string, std::filesystem::path> found;
    std::istringstream lines(outputOf({"ldd", std::filesystem::absolute(program).string()}));
    for (std::string line; std::getline(lines, line);) // "\tlibz.so.1 => /lib/libz.so.1 (0x...)"
    {
        const size_t arrow = line.find(" => ");
        const size_t end = line.rfind(" (0x");
        const size_t begin = line.find_first_not_of('\t');
        if (arrow != std::string::npos && end != std::string::npos && end > arrow + 4)
            found[line.substr(begin, arrow - begin)] = line.substr(arrow + 4, end - arrow - 4);
    }
    return found;
}
} // namespace

Result<std::map<std::string, std::filesystem::path>> librariesToBundle(const std::filesystem::path& program)
{
    const std::map<std::string, std::filesystem::path> resolved = resolvedLibraries(program);
    std::map<std::string, std::filesystem::path> libraries;
    std::vector<std::filesystem::path> open{program};
    while (!open.empty())
    {
        const Result<std::vector<std::string>> needed = neededBy(open.back());
        open.pop_back();
        if (!needed)
            return needed.error();
        for (const std::string& name : *needed)
        {
            if (belongsToTheMachine(name) || libraries.contains(name))
                continue;
            const auto file = resolved.find(name);
            if (file == resolved.end())
                return Error{ExitCode::kIo,
                             fmt::format("the shared library {} is not installed on this machine", name)};
            std::error_code ignored;
            libraries[name] = std::filesystem::canonical(file->second, ignored);
            open.push_back(libraries[name]);
        }
    }
    return libraries;
}
