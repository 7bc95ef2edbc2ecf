#include "runtime/gpu/command_trace.h"

#include <cstring>

CommandTrace::CommandTrace(const Device& device, bool alone)
    : alone_(alone), groups_(device.readback("recorder.groups", kMost * sizeof(uint32_t)))
{
}

void CommandTrace::begin()
{
    commands_.clear();
    timestamps_.clear();
    std::ranges::fill(groups_.mapped(), std::byte{0});
}

void CommandTrace::add(std::string_view name, std::string_view scope, uint64_t bytes, uint32_t first_timestamp)
{
    commands_.push_back({.name = std::string(name), .scope = std::string(scope), .bytes = bytes});
    timestamps_.push_back({.first = first_timestamp, .last = first_timestamp});
}

void CommandTrace::end(std::span<const double> milliseconds)
{
    for (size_t i = 0; i < commands_.size(); ++i)
    {
        commands_[i].ms = milliseconds[timestamps_[i].last] - milliseconds[timestamps_[i].first];
        if (i > 0)
            commands_[i].gap_ms = milliseconds[timestamps_[i].first] - milliseconds[timestamps_[i - 1].last];
        uint32_t groups = 0;
        if (i < kMost)
            std::memcpy(&groups, groups_.mapped().data() + i * sizeof(groups), sizeof(groups));
        commands_[i].groups += groups;
    }
}
