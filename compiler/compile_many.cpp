#include "compiler/compile_many.h"

#include "compiler/dependency_file.h"
#include "compiler/parallel.h"
#include "compiler/report.h"
#include "compiler/up_to_date.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <fstream>

namespace
{
/// One job while it runs. Whatever is printed about it is printed at once, so that lines of jobs do not mix.
class Run
{
public:
    Run(const CompileManyOptions& options, const CompileJob& job, std::mutex& printing)
        : options_(options), job_(job), printing_(printing), name_(job.options.input.string())
    {
    }

    void run(unsigned threads)
    {
        thread_limit = threads;
        const Status status = options_.force || !leaveAlone() ? compileNow() : Success{};
        if (!status)
        {
            const std::lock_guard lock(printing_);
            code_ = reportError(name_, status.error());
        }
    }

    ExitCode code() const { return code_; }
    /// Nothing where the job failed.
    const std::optional<lumicut::fb::ProvenanceT>& provenance() const { return provenance_; }

private:
    bool leaveAlone()
    {
        std::optional<PackageOrigin> origin = readOrigin(job_.options.output);
        if (!origin || !isUpToDate(job_.options, *origin))
            return false;
        if (job_.report && !isReportOf(*job_.report, origin->hash))
            return false;
        if (options_.dependency_file) // make compares times: without this it would run the compiler again and again
            utimensat(AT_FDCWD, job_.options.output.c_str(), nullptr, 0);
        provenance_ = std::move(origin->provenance);
        const std::lock_guard lock(printing_);
        if (!options_.quiet)
            fmt::print("{}: up to date\n", job_.options.output.string());
        return true;
    }

    Status compileNow()
    {
        CompileOptions options = job_.options;
        Cache cache;
        if (options_.cache_folder)
        {
            Result<Cache> opened = Cache::open(*options_.cache_folder);
            if (!opened)
                return opened.error();
            cache = std::move(*opened);
            options.cache = &cache;
        }
        if (!options_.quiet)
            options.progress = [this](double seconds, const std::string& line)
            {
                const std::lock_guard lock(printing_);
                const std::string scene = options_.jobs.size() > 1 ? name_ + ": " : "";
                fmt::print(stderr, "[{:5.2f} s] {}{}\n", seconds, scene, line);
            };
        Result<CompileReport> report = compile(options);
        if (!report)
            return report.error();
        if (!options_.quiet)
            printSummary(*report);
        if (job_.report)
        {
            std::ofstream stream(*job_.report, std::ios::binary);
            if (!(stream << reportJson(*report, options) << std::flush))
                return Error{ExitCode::kIo, "the report cannot be written", job_.report->string()};
        }
        provenance_ = std::move(*report->meta.provenance);
        return Success{};
    }

    void printSummary(const CompileReport& report)
    {
        const std::lock_guard lock(printing_);
        for (const std::string& warning : report.meta.provenance->warnings)
            fmt::print(stderr, "{}: warning: {}\n", name_, warning);
        fmt::print("{}", summaryText(report, job_.options));
        std::fflush(stdout);
    }

    const CompileManyOptions& options_;
    const CompileJob& job_;
    std::mutex& printing_;
    std::string name_;
    ExitCode code_ = ExitCode::kOk;
    std::optional<lumicut::fb::ProvenanceT> provenance_;
};

Status writeDependencies(const CompileManyOptions& options, const std::vector<Run>& runs)
{
    std::string rules;
    for (size_t i = 0; i < runs.size(); ++i)
    {
        if (!runs[i].provenance())
            continue;
        const CompileOptions& job = options.jobs[i].options;
        const Result<std::string> rule = dependencyRule(job.output, inputPaths(job, *runs[i].provenance()));
        if (!rule)
            return rule.error().about(job.input.string());
        rules += *rule;
    }
    std::ofstream stream(*options.dependency_file, std::ios::binary);
    if (!(stream << rules << std::flush))
        return Error{ExitCode::kIo, "the dependency file cannot be written", options.dependency_file->string()};
    return Success{};
}
} // namespace

ExitCode compileMany(const CompileManyOptions& options)
{
    std::mutex printing;
    std::vector<Run> runs;
    for (const CompileJob& job : options.jobs)
        runs.emplace_back(options, job, printing);
    // In parallel rather than each on all threads: much of a compilation is sequential.
    const auto side_by_side = unsigned(std::min<size_t>(options.threads, runs.size()));
    thread_limit = side_by_side;
    parallelFor(runs.size(), [&](size_t i) { runs[i].run(options.threads / side_by_side); });
    thread_limit = options.threads;

    ExitCode code = ExitCode::kOk;
    for (const Run& run : runs)
        if (code == ExitCode::kOk)
            code = run.code();
    if (options.cache_folder)
        if (const Result<Cache> cache = Cache::open(*options.cache_folder))
            cache->trim(options.cache_bytes);
    if (options.dependency_file)
        if (const Status status = writeDependencies(options, runs); !status && code == ExitCode::kOk)
            code = reportError("lumicut-compile", status.error());
    return code;
}

ExitCode reportError(const std::string& file, const Error& error)
{
    for (const std::string& detail : error.details)
        fmt::print(stderr, "{}: error: {}\n", file, detail);
    fmt::print(stderr, "{}: error: {}\n", error.file.empty() ? file : error.file, error.message);
    return error.code;
}
