// Seeds of a sequence's frames.
#include "runtime/frame_seed.h"

#include <gtest/gtest.h>

#include <set>

namespace
{
TEST(FrameSeed, IsAnotherForEveryFrameAndForEverySeed)
{
    std::set<uint32_t> seeds;
    for (int64_t frame = -100; frame < 10000; ++frame)
        seeds.insert(frameSeed(7, frame));
    EXPECT_EQ(seeds.size(), 10100u);
    size_t shared = 0;
    for (int64_t frame = -100; frame < 10000; ++frame)
        shared += seeds.count(frameSeed(8, frame));
    EXPECT_EQ(shared, 0u); // as by chance: 10100 * 10100 / 2^32 are expected
}
} // namespace
