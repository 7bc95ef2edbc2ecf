#include "tests/compiler/program_run.h"

#include <fmt/format.h>

#include <sys/wait.h>

#include <array>
#include <cstdio>

ProgramRun runCompiler(const std::string& arguments)
{
    ProgramRun result;
    FILE* pipe = popen(fmt::format("'{}' {} 2>&1", LUMICUT_COMPILE_PROGRAM, arguments).c_str(), "r");
    std::array<char, 4096> buffer;
    for (size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
        result.output.append(buffer.data(), n);
    const int status = pclose(pipe);
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
}
