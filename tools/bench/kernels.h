// The time of a frame by command.
#pragma once
#include "tools/bench/opened.h"

#include <functional>
#include <nlohmann/json_fwd.hpp>

class CommandSamples
{
public:
    /// Renders frames with each command timed by itself; on a CPU then as many again with each command submitted by itself.
    /// @param record records frame i into the recorder; @param first of `count` frames
    static CommandSamples measure(const Device& device, Recorder& rec, const std::function<void(uint32_t)>& record,
                                  uint32_t first, uint32_t count);

    void print() const;
    nlohmann::ordered_json json() const;

private:
    explicit CommandSamples(bool is_cpu) : is_cpu_(is_cpu) {}

    struct Command
    {
        CommandCost last; // of the last frame
        std::vector<double> ms, gap_ms, cpu_ms;
        std::string statistics; // of the kernel's machine code, in the driver's words
    };
    /// Adds a frame, and forgets those before it whose commands were others.
    static void add(std::vector<Command>& commands, const std::vector<CommandCost>& frame);
    void printSums() const;

    bool is_cpu_;
    std::vector<Command> commands_; // in order
};
