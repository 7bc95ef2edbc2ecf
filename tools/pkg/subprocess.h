// Runs a program and collects what it prints.
#pragma once
#include <optional>
#include <string>
#include <vector>

/// @param command program (searched in PATH) and arguments, no shell in between
/// @return its standard output, or nothing where it cannot be started or does not exit with 0
std::optional<std::string> outputOf(const std::vector<std::string>& command);
