// Whatever the bytes: reading an OpenEXR picture ends in an error or in pixels that lie in it.
#include "image/read_exr.h"
#include "tests/image/collect.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    Collected collected;
    (void)readExr({reinterpret_cast<const std::byte*>(data), size}, collected);
    return 0;
}
