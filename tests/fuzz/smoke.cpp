// A fuzz target without libFuzzer: the seeds of a folder and a fixed number of changed ones, always the same.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace
{
using Bytes = std::vector<uint8_t>;

void change(Bytes& bytes, std::minstd_rand& random)
{
    constexpr uint8_t kEdges[] = {0, 1, 0x7f, 0x80, 0xfe, 0xff, '0', '9', '-', '"', '\n'};
    if (bytes.empty())
        return;
    // Headers are at the front and decide most.
    const size_t at = random() % (random() % 2 == 0 ? bytes.size() : std::min<size_t>(bytes.size(), 512));
    switch (random() % 6)
    {
    case 0:
        bytes[at] = uint8_t(random());
        break;
    case 1:
        bytes[at] ^= uint8_t(1u << random() % 8);
        break;
    case 2:
        bytes[at] = kEdges[random() % std::size(kEdges)];
        break;
    case 3:
        bytes.resize(at);
        break;
    case 4:
        bytes.erase(bytes.begin() + ptrdiff_t(at),
                    bytes.begin() + ptrdiff_t(std::min(bytes.size(), at + 1 + random() % 8)));
        break;
    case 5:
        std::copy_n(bytes.begin() + ptrdiff_t(random() % bytes.size() / 2),
                    std::min<size_t>(1 + random() % 16, (bytes.size() - at) / 2), bytes.begin() + ptrdiff_t(at));
        break;
    }
}
} // namespace

int main(int argc, char** argv)
{
    if (argc != 3)
    {
        std::fprintf(stderr, "usage: %s SEEDS COUNT\n", argv[0]);
        return 1;
    }
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end()); // the folder's order is none
    if (files.empty())
    {
        std::fprintf(stderr, "%s: error: there are no seeds in this folder\n", argv[1]);
        return 1;
    }
    std::vector<Bytes> seeds;
    for (const auto& path : files)
    {
        std::ifstream file(path, std::ios::binary);
        seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
        LLVMFuzzerTestOneInput(seeds.back().data(), seeds.back().size());
    }
    std::minstd_rand random(1);
    for (int i = 0; i < std::atoi(argv[2]); ++i)
    {
        Bytes bytes = seeds[random() % seeds.size()];
        for (uint32_t k = 0; k <= random() % 3; ++k)
            change(bytes, random);
        LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    }
    return 0;
}
