// lumicut-compare --welch: whether two sets of renderings differ.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace CLI
{
class App;
}

enum class Output
{
    kText,
    kJson,
    kTsv,
};

struct WelchOptions
{
    std::vector<std::string> set, against; // .exr files
    uint32_t tile = 8;
    double alpha = 0.01;
    std::string p_map; // .png or empty

    bool asked() const { return !set.empty(); }
};

void addWelchOptions(CLI::App& app, WelchOptions& options);

/// Prints the result of welch() (tools/compare/welch.h). @param crop as readImages() takes it @return the exit code
int runWelch(const WelchOptions& options, const std::vector<uint32_t>& crop, Output output);
