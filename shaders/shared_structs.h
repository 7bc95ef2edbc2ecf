// Build tool: checks that C++ sees the structs of the shared headers as the kernels do.
#pragma once
#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <ostream>
#include <set>
#include <string>

/// Bytes of a GLSL type in spirv-cross's reflection; of a struct, the end of its last member. Of vectors, matrices and
/// scalars only those that the shared headers use are known.
uint32_t typeBytes(const nlohmann::json& types, const std::string& type);

/// Collects the structs in the kernels' parameters and buffers, as assertions about the C++ structs of those names.
class SharedStructs
{
public:
    /// @param root of the sources, which #include lines are relative to
    explicit SharedStructs(std::filesystem::path root) : root_(std::move(root)) {}

    /// @param source of the kernel, relative to the root; its includes tell which header a struct is defined in
    /// @return "", or a sentence where the kernel's parameters are no struct of a shared header
    std::string add(const std::filesystem::path& source, const nlohmann::json& reflection);
    /// The #include lines and static_asserts.
    void write(std::ostream& out) const;

private:
    using Headers = std::map<std::string, std::string>; // by the name of the struct that they define
    void findHeaders(const std::filesystem::path& file, std::set<std::filesystem::path>& seen, Headers& headers) const;
    bool addStruct(const std::string& type, const nlohmann::json& types, const Headers& headers);

    std::filesystem::path root_;
    std::set<std::string> includes_, assertions_; // lines
};
