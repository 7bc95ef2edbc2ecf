// Damage that happens to files: cut short, bits flipped, mangled as text.
#include "tests/format/rehash.h"
#include "tests/format/sample_package.h"
#include "tests/format/walk_package.h"

#include <gtest/gtest.h>

TEST(PackageDamage, EveryTruncationIsRejected)
{
    const std::vector<std::byte> bytes = SamplePackage().bytes();
    for (size_t size = 0; size < bytes.size(); ++size)
    {
        const auto package = package::Package::openBytes(std::span(bytes).first(size));
        ASSERT_FALSE(package) << size;
        ASSERT_EQ(package.error().code, ExitCode::kInvalid) << size;
        ASSERT_NE(package.error().message.find("truncated"), std::string::npos) << size << package.error().message;
    }
}

TEST(PackageDamage, EverySingleBitFlipIsRejected)
{
    std::vector<std::byte> bytes = SamplePackage().bytes();
    for (size_t i = 0; i < bytes.size(); ++i)
    {
        // Padding is compared to 0 byte by byte: one bit of each is enough there.
        const int bits = bytes[i] == std::byte{0} && i % 16 != 0 ? 1 : 8;
        for (int bit = 0; bit < bits; ++bit)
        {
            bytes[i] ^= std::byte(1 << bit);
            ASSERT_FALSE(package::Package::openBytes(bytes)) << "byte " << i << " bit " << bit;
            bytes[i] ^= std::byte(1 << bit);
        }
    }
}

TEST(PackageDamage, BitFlipsBehindRightHashesAreRejectedOrHarmless)
{
    const std::vector<std::byte> bytes = SamplePackage().bytes();
    size_t accepted = 0;
    size_t rejected = 0;
    for (size_t i = sizeof(package::Header); i < bytes.size(); ++i)
    {
        if (bytes[i] == std::byte{0} && i % 64 != 0)
            continue;
        for (int bit = 0; bit < 8; ++bit)
        {
            std::vector<std::byte> flipped = bytes;
            flipped[i] ^= std::byte(1 << bit);
            rehash(flipped);
            const auto package = package::Package::openBytes(flipped);
            if (package)
                walkPackage(*package); // aborts where an index leads outside
            ++(package ? accepted : rejected);
        }
    }
    EXPECT_GT(accepted, 1000u); // a texel or a colour may be anything
    EXPECT_GT(rejected, 1000u);
}

TEST(PackageDamage, TextModeTransferIsNamed)
{
    const std::vector<std::byte> bytes = SamplePackage().bytes();
    std::vector<std::byte> mangled; // CR LF becomes LF
    for (size_t i = 0; i < bytes.size(); ++i)
    {
        if (bytes[i] != std::byte{'\r'} || bytes[i + 1] != std::byte{'\n'})
            mangled.push_back(bytes[i]);
    }
    const auto package = package::Package::openBytes(mangled);
    ASSERT_FALSE(package);
    EXPECT_NE(package.error().message.find("text mode"), std::string::npos) << package.error().message;
}
