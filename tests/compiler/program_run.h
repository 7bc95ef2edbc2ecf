// Runs lumicut-compile as its users do.
#pragma once
#include <string>

struct ProgramRun
{
    int code = -1;
    std::string output; // stdout and stderr
};

/// In the current folder, by way of a shell.
ProgramRun runCompiler(const std::string& arguments);
