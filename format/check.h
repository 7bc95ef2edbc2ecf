// check(): a bug stops the program and prints the values that reveal it, in release builds, too.
#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

/// Aborts with a formatted message unless `condition` holds. For callers' mistakes only; bad input gets a Result.
#define check(condition, ...) \
    do \
    { \
        if (!(condition)) \
        { \
            fmt::print(stderr, "{}:{}: check failed: {}: {}\n", __FILE__, __LINE__, #condition, \
                       fmt::format(__VA_ARGS__)); \
            std::abort(); \
        } \
    } while (false)
