#include "compiler/dependency_file.h"

#include <fmt/format.h>

namespace
{
std::string escaped(const std::string& name)
{
    std::string out;
    size_t backslashes = 0; // directly before this character
    for (const char c : name)
    {
        if (c == ' ' || c == '\t')
            out.append(backslashes + 1, '\\'); // those before a blank would escape it, or each other
        else if (c == '#')
            out.push_back('\\');
        else if (c == '$')
            out.push_back('$');
        out.push_back(c);
        backslashes = c == '\\' ? backslashes + 1 : 0;
    }
    return out;
}
} // namespace

Result<std::string> dependencyRule(const std::filesystem::path& output,
                                   const std::vector<std::filesystem::path>& inputs)
{
    std::string rule = escaped(output.string()) + ":";
    std::string empty_rules;
    for (const std::filesystem::path& input : inputs)
    {
        rule += " \\\n  " + escaped(input.string());
        empty_rules += fmt::format("\n{}:\n", escaped(input.string()));
    }
    for (const auto& path : inputs)
        if (path.string().find_first_of("\n\r") != std::string::npos)
            return Error{ExitCode::kUsage,
                         "the names of its files have line breaks, which a dependency file cannot hold; rename them"};
    if (output.string().find_first_of("\n\r") != std::string::npos)
        return Error{ExitCode::kUsage, "the package's name has a line break, which a dependency file cannot hold"};
    return rule + "\n" + empty_rules;
}
