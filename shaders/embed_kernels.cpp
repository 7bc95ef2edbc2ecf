// Build tool: turns SPIR-V files and spirv-cross's JSON reflection of them into one C++ file of KernelCode tables.
// embed_kernels OUT.cpp SOURCE_ROOT FOLDER FUNCTION NAME SPV JSON [NAME SPV JSON ...], sorted by name by the caller; the kernels'
// sources lie in FOLDER below SOURCE_ROOT, and FUNCTION() returns their tables.
#include "shaders/shared_structs.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

namespace
{
struct Module
{
    std::string name;
    std::vector<uint32_t> words;
    nlohmann::json reflection;
};

[[noreturn]] void fail(const std::string& kernel, const std::string& sentence)
{
    std::cerr << "embed_kernels: " << kernel << ": " << sentence << "\n";
    std::exit(1);
}

std::string identifier(std::string name)
{
    std::replace(name.begin(), name.end(), '/', '_');
    return name;
}

std::vector<uint32_t> readWords(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
    std::vector<uint32_t> words(bytes.size() / 4);
    std::memcpy(words.data(), bytes.data(), words.size() * 4);
    return words;
}

/// local_size_x. spirv-cross does not know LocalSizeId, which glslang emits for sizes given by a constant.
uint32_t groupSize(const Module& module)
{
    const std::vector<uint32_t>& words = module.words;
    constexpr uint32_t kExecutionMode = 16, kExecutionModeId = 331, kConstant = 43, kLocalSize = 17, kLocalSizeId = 38;
    uint32_t size_id = 0;
    for (size_t i = 5; i < words.size(); i += words[i] >> 16)
    {
        const uint32_t op = words[i] & 0xffffu;
        if (op == kExecutionMode && words[i + 2] == kLocalSize)
            return words[i + 3];
        if (op == kExecutionModeId && words[i + 2] == kLocalSizeId)
            size_id = words[i + 3];
        if (op == kConstant && size_id != 0 && words[i + 2] == size_id)
            return words[i + 3];
    }
    fail(module.name, "it has no group size");
}

/// Set 1: what the caller binds.
void writeBlocks(std::ostream& out, const nlohmann::json& reflection)
{
    for (const auto& block : reflection.value("ssbos", nlohmann::json::array()))
        if (block.at("set") == 1)
            out << "    {\"" << block.at("name").get<std::string>() << "\", " << block.at("binding") << ", "
                << (block.value("writeonly", false) ? "false" : "true") << ", "
                << (block.value("readonly", false) ? "false" : "true") << ", false},\n";
    for (const auto& image : reflection.value("separate_images", nlohmann::json::array()))
        if (image.at("set") == 1)
            out << "    {\"" << image.at("name").get<std::string>() << "\", " << image.at("binding")
                << ", true, false, true},\n";
}

/// Set 0: buffers of the scene, which kernels only read. Its images never change.
void writeSceneBindings(std::ostream& out, const Module& module)
{
    for (const char* kind : {"ubos", "ssbos", "separate_images"})
        for (const auto& block : module.reflection.value(kind, nlohmann::json::array()))
            if (block.at("set") == 0)
            {
                if (kind == std::string("ssbos") && !block.value("readonly", false))
                    fail(module.name,
                         "block '" + block.at("name").get<std::string>() + "' of the scene must be readonly");
                out << block.at("binding") << ", ";
            }
}

void writeConstants(std::ostream& out, const Module& module)
{
    for (const auto& constant : module.reflection.value("specialization_constants", nlohmann::json::array()))
    {
        const std::string name = constant.value("name", "");
        if (name.empty())
            fail(module.name, "specialization constant " + constant.at("id").dump() + " has no name");
        out << "    {\"" << name << "\", " << constant.at("id") << "},\n";
    }
}

// Each array ends with an element that is left out again: C++ has no arrays of length 0.
void writeKernel(std::ostream& out, const Module& module)
{
    const std::string id = identifier(module.name);
    out << "constexpr uint32_t k_" << id << "_words[]{";
    for (size_t i = 0; i < module.words.size(); ++i)
        out << (i % 16 == 0 ? "\n" : "") << module.words[i] << "u,";
    out << "};\nconstexpr KernelBlock k_" << id << "_blocks[]{\n";
    writeBlocks(out, module.reflection);
    out << "    {\"\", 0, false, false, false}};\nconstexpr uint32_t k_" << id << "_scene[]{";
    writeSceneBindings(out, module);
    out << "0};\nconstexpr KernelConstant k_" << id << "_constants[]{\n";
    writeConstants(out, module);
    out << "    {\"\", 0}};\n";
}

void writeEntry(std::ostream& out, const Module& module)
{
    const auto& push = module.reflection.value("push_constants", nlohmann::json::array());
    const uint32_t push_bytes = push.empty() ? 0 : typeBytes(module.reflection.at("types"), push.at(0).at("type"));
    out << "    {\"" << module.name << "\", k_" << identifier(module.name) << "_words, ";
    for (const char* part : {"_blocks", "_scene", "_constants"})
        out << "allButLast(k_" << identifier(module.name) << part << "), ";
    out << push_bytes << ", " << groupSize(module) << "},\n";
}
} // namespace

int main(int argc, char** argv)
{
    std::vector<Module> modules;
    SharedStructs structs(argv[2]);
    for (int i = 5; i + 2 < argc; i += 3)
    {
        modules.push_back({argv[i], readWords(argv[i + 1]), nlohmann::json::parse(std::ifstream(argv[i + 2]))});
        if (const std::string error =
                structs.add(std::string(argv[3]) + "/" + modules.back().name + ".comp", modules.back().reflection);
            !error.empty())
            fail(modules.back().name, error);
    }
    std::ofstream out(argv[1]);
    out << "// Generated by embed_kernels; do not edit.\n#include \"runtime/gpu/kernel.h\"\n";
    structs.write(out);
    out << "namespace {\ntemplate <typename T, size_t kCount>\n"
           "constexpr std::span<const T> allButLast(const T (&array)[kCount]) { return {array, kCount - 1}; }\n";
    for (const Module& module : modules)
        writeKernel(out, module);
    out << "constexpr KernelCode kCodes[]{\n";
    for (const Module& module : modules)
        writeEntry(out, module);
    out << "};\n}\nstd::span<const KernelCode> " << argv[4] << "();\nstd::span<const KernelCode> " << argv[4]
        << "() { return kCodes; }\n";
    out.close();
    return out ? 0 : 1;
}
