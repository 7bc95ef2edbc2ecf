// Whatever is assigned: settings end in an error or within their ranges. Lines are assignments, the first a preset.
#include "format/check.h"
#include "runtime/settings.h"

#include <sstream>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    std::istringstream text(std::string(reinterpret_cast<const char*>(data), size));
    std::string preset;
    std::getline(text, preset);
    std::vector<std::string> assignments;
    for (std::string line; std::getline(text, line);)
        assignments.push_back(line);
    if (const Result<Settings> settings = makeSettings(preset, assignments))
        for (const Setting& setting : allSettings())
        {
            const float value = std::visit([&](auto member) { return float((*settings).*member); }, setting.member);
            check(value >= float(setting.least) && value <= float(setting.most), "{} = {}", setting.name, value);
        }
    return 0;
}
