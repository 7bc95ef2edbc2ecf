// The report on a finished package: a summary as text, and JSON.
#pragma once
#include "compiler/compile.h"

/// Several lines of plain text.
std::string summaryText(const CompileReport& report, const CompileOptions& options);

/// JSON, schema "lumicut-compile-report/1": fields are only ever added. "warnings" are sentences, many alike summed;
/// "findings" is each of them: kind (kindName()), JSON pointer into the scene or "", message, stand_in or "", damage.
std::string reportJson(const CompileReport& report, const CompileOptions& options);

/// Whether the file `report` is the report of the package with this hash.
bool isReportOf(const std::filesystem::path& report, uint64_t package_hash);
