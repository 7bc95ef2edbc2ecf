// Runs a program and collects what it prints.
#pragma once
#include <string>
#include <vector>

/// @param command program (searched in PATH) and arguments, no shell in between
/// @return its standard output, whatever its exit code; empty where it cannot be started
std::string outputOf(const std::vector<std::string>& command);
