// check(): bugs of our own stop the program with the values that show them, in release builds too.
#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

/// Aborts with a formatted message unless `condition` holds. For callers' mistakes only; bad input gets a Result.
#define check(condition, ...)                                                                                          \
    do                                                                                                                 \
    {                                                                                                                  \
        if (!(condition))                                                                                              \
        {                                                                                                              \
            fmt::print(stderr, "{}:{}: check failed: {}: {}\n", __FILE__, __LINE__, #condition,                        \
                       fmt::format(__VA_ARGS__));                                                                      \
            std::abort();                                                                                              \
        }                                                                                                              \
    } while (false)
