// Where what can be made again is kept for this user.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <optional>

/// "lumicut" below $XDG_CACHE_HOME, else below ~/.cache; nothing where neither variable is set. It may not exist yet.
inline std::optional<std::filesystem::path> cacheFolder()
{
    if (const char* cache_home = std::getenv("XDG_CACHE_HOME"))
        return std::filesystem::path(cache_home) / "lumicut";
    if (const char* home = std::getenv("HOME"))
        return std::filesystem::path(home) / ".cache" / "lumicut";
    return std::nullopt;
}
