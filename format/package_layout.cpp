#include "format/package_layout.h"

namespace package
{
std::string chunkName(uint32_t id)
{
    std::string name(4, '?');
    for (size_t i = 0; i < name.size(); ++i)
    {
        const char c = char(id >> (8 * i) & 0xff);
        if (c >= 0x20 && c < 0x7f)
            name[i] = c;
    }
    return name;
}
} // namespace package
