// Several scenes in one call: each with its threads, what is up to date left alone, one message stream.
#pragma once
#include "compiler/compile.h"

struct CompileJob
{
    CompileOptions options;                        // `progress` and `cache` are filled in here
    std::optional<std::filesystem::path> report{}; // where its report goes
};

struct CompileManyOptions
{
    std::vector<CompileJob> jobs;
    unsigned threads = 1;                                   // in all, 1 and more
    bool force = false;                                     // compile what is up to date, too
    bool quiet = false;                                     // print errors only
    std::optional<std::filesystem::path> cache_folder{};    // kept results of earlier runs
    uint64_t cache_bytes = 0;                               // to which it is trimmed in the end
    std::optional<std::filesystem::path> dependency_file{}; // of all packages that are there in the end
};

/// Compiles every job, however many fail, and prints the result of each. @return the code of the first in order that
/// failed
ExitCode compileMany(const CompileManyOptions& options);

/// "file: error: text" on stderr. @return the error's code
ExitCode reportError(const std::string& file, const Error& error);
