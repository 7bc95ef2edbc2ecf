// Runs independent checks side by side; which error is reported does not depend on timing.
#pragma once
#include "format/result.h"

#include <cstdint>
#include <functional>
#include <span>

namespace package
{
/// Runs all `tasks` (on several threads where `parallel`).
/// @return the error of the first task in order that has one; kDevice where memory ran out in one of them
Status runAll(std::span<const std::function<Status()>> tasks, bool parallel);
} // namespace package
