// The message about text that is not valid JSON.
#pragma once
#include "format/result.h"

/// @param what the JSON library's words: "[json.exception.parse_error.101] parse error at line 1, ...: ..."
inline Error badJson(std::string what)
{
    if (const size_t end = what.find("] "); end != std::string::npos)
        what.erase(0, end + 2);
    for (char& c : what)
        c = c == '\n' ? ' ' : c;
    return {ExitCode::kInvalid, "its JSON cannot be read: " + what};
}
