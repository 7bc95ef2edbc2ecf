// Which glTF extensions the compiler supports.
#pragma once
#include "compiler/warnings.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

/// @return kUnsupported naming the first required extension that is not supported; otherwise adds one warning that
///         lists what the file uses and the compiler drops
Status checkExtensions(const nlohmann::json& document, Warnings& warnings);
