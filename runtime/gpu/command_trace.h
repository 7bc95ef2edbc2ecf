// What every command of a submission costs. For measurements: it adds two timestamps to each.
#pragma once
#include "runtime/gpu/device.h"

/// A dispatch, fill, copy or write.
struct CommandCost
{
    std::string name;                     // of the kernel, or "fill", "copy", "write"
    std::string scope;                    // the innermost
    VkPipeline pipeline = VK_NULL_HANDLE; // of a dispatch
    uint32_t groups = 0;
    uint64_t bytes = 0; // of the buffers that it names, each as a whole
    double gap_ms = 0;  // from the end of the command before to its begin
    double ms = 0;
    double cpu_ms = 0; // of this process, all threads: what a device that is a CPU worked; 0 unless `alone`
};

class CommandTrace
{
public:
    /// @param alone whether each command is submitted by itself, so that its CPU time is known; gaps then mean nothing
    explicit CommandTrace(const Device& device, bool alone = false);

    /// Of the last submission that has ended, in order.
    const std::vector<CommandCost>& commands() const { return commands_; }

private:
    friend class Recorder;
    static constexpr uint32_t kMost = 4096; // commands of which groups are read back

    void begin();
    void add(std::string_view name, std::string_view scope, uint64_t bytes, uint32_t first_timestamp);
    /// @param milliseconds of each timestamp
    void end(std::span<const double> milliseconds);

    struct Timestamps
    {
        uint32_t first, last;
    };
    bool alone_;
    Buffer groups_; // uint[kMost], of what is dispatched indirectly; else 0
    std::vector<CommandCost> commands_;
    std::vector<Timestamps> timestamps_; // of each
};
