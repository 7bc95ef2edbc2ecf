#include "format/package_read.h"
#include "tools/pkg/commands.h"

#include <algorithm>

ExitCode validate(const std::vector<std::filesystem::path>& packages)
{
    ExitCode worst = ExitCode::kOk;
    for (const std::filesystem::path& path : packages)
    {
        if (const auto package = package::Package::open(path); !package)
            worst = std::max(worst, report(path, package.error()));
    }
    return worst;
}
