#include "tools/bench/kernels.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace
{
bool isDispatch(const CommandCost& cost)
{
    return cost.name != "fill" && cost.name != "copy" && cost.name != "write";
}

double median(const std::vector<double>& values)
{
    return values.empty() ? 0 : percentile(values, 0.5);
}
} // namespace

void CommandSamples::add(std::vector<Command>& commands, const std::vector<CommandCost>& frame)
{
    const auto same = [](const Command& command, const CommandCost& cost)
    { return command.last.name == cost.name && command.last.scope == cost.scope; };
    if (!std::ranges::equal(commands, frame, same))
        commands.assign(frame.size(), Command{});
    for (size_t i = 0; i < frame.size(); ++i)
    {
        commands[i].last = frame[i];
        commands[i].ms.push_back(frame[i].ms);
        commands[i].gap_ms.push_back(frame[i].gap_ms);
        commands[i].cpu_ms.push_back(frame[i].cpu_ms);
    }
}

CommandSamples CommandSamples::measure(const Device& device, Recorder& rec, const std::function<void(uint32_t)>& record,
                                       uint32_t first, uint32_t count)
{
    const auto trace = [&](bool alone, uint32_t begin)
    {
        CommandTrace frame(device, alone);
        std::vector<Command> commands;
        rec.traceInto(&frame);
        for (uint32_t i = 0; i < count; ++i)
        {
            record(begin + i);
            rec.submitAndWait();
            add(commands, frame.commands());
        }
        rec.traceInto(nullptr);
        return commands;
    };
    CommandSamples samples(device.isCpu());
    samples.commands_ = trace(false, first);
    for (Command& command : samples.commands_)
        command.statistics = fmt::format("{}", fmt::join(device.statistics(command.last.pipeline), ", "));
    if (!samples.is_cpu_)
        return samples;
    const std::vector<Command> alone = trace(true, first + count);
    for (size_t i = 0; i < samples.commands_.size() && alone.size() == samples.commands_.size(); ++i)
        samples.commands_[i].cpu_ms = alone[i].cpu_ms;
    return samples;
}

void CommandSamples::printSums() const
{
    struct Sum
    {
        std::string name;
        uint32_t count = 0;
        double ms = 0, cpu_ms = 0;
        std::string statistics;
    };
    std::vector<Sum> sums;
    for (const Command& command : commands_)
    {
        auto sum = std::ranges::find(sums, command.last.name, &Sum::name);
        if (sum == sums.end())
            sum = sums.insert(sums.end(), Sum{.name = command.last.name, .statistics = command.statistics});
        ++sum->count;
        sum->ms += median(command.ms);
        sum->cpu_ms += median(command.cpu_ms);
    }
    std::ranges::stable_sort(sums, std::greater{}, is_cpu_ ? &Sum::cpu_ms : &Sum::ms);
    for (const Sum& sum : sums)
        fmt::print("  {:<40} {:>8} {:>19.3f} {}{}\n", sum.name, sum.count, sum.ms,
                   is_cpu_ ? fmt::format("{:10.3f}", sum.cpu_ms) : "", sum.statistics);
}

void CommandSamples::print() const
{
    double ms = 0, gaps = 0, cpu_ms = 0;
    size_t dispatches = 0;
    const std::string cpu_title = is_cpu_ ? fmt::format("{:>10}", "CPU ms") : "";
    fmt::print("  {:<40} {:>8} {:>8} {:>10} {} {:>10}\n", "commands of a frame", "groups", "MiB", "ms", cpu_title,
               "gap ms");
    for (const Command& command : commands_)
    {
        const CommandCost& cost = command.last;
        fmt::print("  {:<40} {:>8} {:>8.1f} {:>10.3f} {} {:>10.3f}\n", fmt::format("{}: {}", cost.scope, cost.name),
                   cost.groups, double(cost.bytes) / (1 << 20), median(command.ms),
                   is_cpu_ ? fmt::format("{:10.3f}", median(command.cpu_ms)) : "", median(command.gap_ms));
        ms += median(command.ms);
        gaps += median(command.gap_ms);
        cpu_ms += median(command.cpu_ms);
        dispatches += isDispatch(cost);
    }
    fmt::print("  {:<40} {:>8} {:>19} {}\n", "by kernel", "commands", "ms", cpu_title);
    printSums();
    fmt::print("  {} commands, {} of them dispatches: {:.3f} ms in them, {:.3f} ms between them{}\n", commands_.size(),
               dispatches, ms, gaps, is_cpu_ ? fmt::format(", {:.3f} ms of CPU time", cpu_ms) : "");
}

nlohmann::ordered_json CommandSamples::json() const
{
    auto list = nlohmann::ordered_json::array();
    for (const Command& command : commands_)
    {
        nlohmann::ordered_json entry{
            {"name", command.last.name},   {"stage", command.last.scope},  {"groups", command.last.groups},
            {"bytes", command.last.bytes}, {"p50_ms", median(command.ms)}, {"gap_p50_ms", median(command.gap_ms)},
        };
        if (is_cpu_)
            entry["cpu_p50_ms"] = median(command.cpu_ms);
        if (!command.statistics.empty())
            entry["driver"] = command.statistics;
        list.push_back(entry);
    }
    return list;
}
