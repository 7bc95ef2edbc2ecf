// Manual pages and shell completions, generated from a program's command line, so that they cannot disagree with it.
#pragma once
#include <CLI/CLI.hpp>

#include <string>
#include <vector>

/// Adds the hidden options --manual and --completion bash|zsh|fish, which print and end the program with code 0.
void addDocumentation(CLI::App& app);

/// The manual page, section 1, in the man macros of roff.
std::string manualPage(const CLI::App& app);

/// @param shell bash, zsh or fish
std::string completion(const CLI::App& app, const std::string& shell);

/// The data of an option for both; hidden options are left out.
struct OptionText
{
    std::vector<std::string> names;   // with their dashes; empty for a positional argument
    std::string argument;             // what its value is called, empty for a flag
    std::vector<std::string> choices; // values, where they are few and known
    std::string description;          // with the default
    bool required = false;
    bool several = false; // takes more than one value
};
std::vector<OptionText> optionTexts(const CLI::App& app);
