// References are rendered once, and again where the file is not what was written.
#include "tools/bench/reference_cache.h"

#include "tests/tools/random_image.h"
#include "tests/tools/temporary_folder.h"

#include <gtest/gtest.h>

namespace
{
class ReferenceCacheTest : public testing::Test
{
protected:
    ImageF get(const ReferenceKey& key)
    {
        const auto picture = ReferenceCache(folder_ / "a/b")
                                 .picture(key, [&] { return randomImage(key.width, key.height, ++rendered_); });
        EXPECT_TRUE(picture) << picture.error().message;
        return *picture;
    }

    TemporaryFolder folder_;
    ReferenceKey key_{
        .package = 1, .camera = {}, .width = 7, .height = 5, .sample_count = 16, .depth_limit = 64, .term = 0};
    uint32_t rendered_ = 0;
};
} // namespace

TEST_F(ReferenceCacheTest, ThePictureIsKeptToTheLastBit)
{
    const ImageF first = get(key_);
    EXPECT_EQ(get(key_).rgb, first.rgb);
    EXPECT_EQ(rendered_, 1u);
}

TEST_F(ReferenceCacheTest, EveryPartOfTheKeyCountsButTheCamerasName)
{
    get(key_);
    std::vector<ReferenceKey> others(10, key_);
    others[0].package = 2;
    others[1].camera.position.y = 1e-3f;
    others[2].camera.vertical_fov = 0.81f;
    others[3].camera.far_plane = 9;
    others[4].height = 6;
    others[5].sample_count = 17;
    others[6].depth_limit = 65;
    others[7].term = 1;
    others[9].lights = 1;
    std::swap(others[8].width, others[8].height);
    for (const ReferenceKey& other : others)
        get(other);
    EXPECT_EQ(rendered_, 11u);
    ReferenceKey renamed = key_;
    renamed.camera.name = "hall";
    get(renamed);
    EXPECT_EQ(rendered_, 11u);
}

TEST_F(ReferenceCacheTest, DamagedFilesAreMadeAgain)
{
    get(key_);
    const std::filesystem::path file = ReferenceCache(folder_ / "a/b").fileOf(key_);
    const std::string whole = fileBytes(file);
    std::string flipped = whole, longer = whole + "x";
    flipped[whole.size() / 2] = char(flipped[whole.size() / 2] ^ 1);
    uint32_t expected = 1;
    for (const std::string& damaged :
         {whole.substr(0, whole.size() - 1), whole.substr(0, 3), std::string(), flipped, longer})
    {
        std::ofstream(file, std::ios::binary) << damaged;
        get(key_);
        EXPECT_EQ(rendered_, ++expected);
        get(key_);
        EXPECT_EQ(rendered_, expected) << "the new file is whole";
    }
}

TEST_F(ReferenceCacheTest, AFolderThatCannotBeMadeIsSaid)
{
    std::ofstream(folder_ / "file") << "no folder";
    const auto picture = ReferenceCache(folder_ / "file/below").picture(key_, [&] { return randomImage(7, 5, 1); });
    ASSERT_FALSE(picture);
    EXPECT_EQ(picture.error().code, ExitCode::kIo);
}
