// Pictures that the player writes: layers of OpenEXR files, and whether what lies on the disk is whole.
#include "image/picture_file.h"
#include "image/png_chunks.h"
#include "image/read_exr.h"
#include "image/write_image.h"
#include "tests/tools/temporary_folder.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>

namespace
{
constexpr uint32_t kWidth = 5, kHeight = 40; // more lines than a block of ZIP compression has

std::vector<float> numbers(size_t channels, float first)
{
    std::vector<float> values(channels * kWidth * kHeight);
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = first + 1.0001f * float(i); // more digits than a half holds
    return values;
}

/// One channel, as OpenEXR itself reads it.
std::vector<float> channel(const std::filesystem::path& path, const std::string& name)
{
    Imf::InputFile file(path.c_str());
    std::vector<float> values(kWidth * kHeight, -1);
    Imf::FrameBuffer target;
    target.insert(
        name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float), sizeof(float) * kWidth));
    file.setFrameBuffer(target);
    file.readPixels(0, int(kHeight) - 1);
    return values;
}

TEST(ExrLayers, EachChannelIsFoundUnderItsName)
{
    const TemporaryFolder folder;
    const std::vector<float> beauty = numbers(3, 1), direct = numbers(3, 1000), motion = numbers(2, -50),
                             depth = numbers(1, 7);
    std::vector<float> normal = numbers(3, 0);
    for (float& value : normal)
        value = std::sin(value);
    normal[0] = 1e6f; // beyond the largest half
    const ExrLayer layers[] = {{"", "RGB", beauty},
                               {"direct", "RGB", direct},
                               {"motion", "XY", motion},
                               {"", "Z", depth},
                               {"normal", "XYZ", normal, true}};
    ASSERT_TRUE(writeExr(folder / "a.exr", kWidth, kHeight, layers));

    std::string names;
    const Imf::InputFile file((folder / "a.exr").c_str());
    for (auto i = file.header().channels().begin(); i != file.header().channels().end(); ++i)
        names += std::string(i.name()) + (i.channel().type == Imf::HALF ? "(half) " : " ");
    EXPECT_EQ(names,
              "B G R Z direct.B direct.G direct.R motion.X motion.Y normal.X(half) normal.Y(half) normal.Z(half) ");
    for (const ExrLayer& layer : layers)
        for (size_t c = 0; c < layer.channels.size(); ++c)
        {
            const std::string name = (layer.name.empty() ? "" : layer.name + ".") + layer.channels[c];
            const std::vector<float> read = channel(folder / "a.exr", name);
            for (size_t pixel = 0; pixel < read.size(); ++pixel)
            {
                const float want =
                    std::min(layer.values[pixel * layer.channels.size() + c], layer.half ? 65504.0f : INFINITY);
                ASSERT_NEAR(read[pixel], want, layer.half ? std::abs(want) / 2048 + 6e-8 : 0) << name; // half an ulp
            }
        }
}

TEST(ExrLayers, ThePictureIsReadAsBeforeAndTheirOrderDoesNotShow)
{
    const TemporaryFolder folder;
    const std::vector<float> beauty = numbers(3, 1), other = numbers(3, 1000);
    const ExrLayer layers[] = {{"", "RGB", beauty}, {"direct", "RGB", other}};
    const ExrLayer turned[] = {layers[1], layers[0]};
    ASSERT_TRUE(writeExr(folder / "a.exr", kWidth, kHeight, layers));
    ASSERT_TRUE(writeExr(folder / "b.exr", kWidth, kHeight, turned));
    EXPECT_EQ(fileBytes(folder / "a.exr"), fileBytes(folder / "b.exr"));
    const auto read = readExr(folder / "a.exr");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->rgb, beauty);
}

const std::vector<PictureNote> kNotes{{"lumicut.package", "0123"}, {"lumicut.settings", "seed 1\nfps 24\n"}};

TEST(PictureNotes, AreReadAsWrittenAndLeaveThePictureAsItIs)
{
    const TemporaryFolder folder;
    const std::vector<uint8_t> grey(3 * kWidth * kHeight, 77);
    for (const std::vector<PictureNote>& notes : {kNotes, std::vector<PictureNote>()})
    {
        ASSERT_TRUE(writeExr(folder / "a.exr", {kWidth, kHeight, numbers(3, 1)}, notes));
        ASSERT_TRUE(writePng(folder / "a.png", kWidth, kHeight, 3, grey, notes));
        for (const char* name : {"a.exr", "a.png"})
        {
            EXPECT_EQ(pictureState(folder / name, kWidth, kHeight), PictureState::kWhole) << name;
            const auto read = readPictureNotes(folder / name);
            ASSERT_TRUE(read) << read.error().message;
            EXPECT_EQ(*read, notes) << name;
        }
        EXPECT_EQ(channel(folder / "a.exr", "G")[0], numbers(3, 1)[1]);
    }
    std::ofstream(folder / "text.exr") << "notes on frame 3";
    const auto other = readPictureNotes(folder / "text.exr");
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().code, ExitCode::kInvalid);
}

/// Chunks that a strict reader refuses would make the picture useless.
TEST(PictureNotes, HaveTheChecksumsOfPng)
{
    const std::vector<uint8_t> bytes = encodePng(4, 4, 3, std::vector<uint8_t>(3 * 16), kNotes);
    size_t texts = 0;
    const std::span<const std::byte> file = std::as_bytes(std::span(bytes));
    forEachPngChunk(file,
                    [&](uint32_t type, std::span<const std::byte> data)
                    {
                        texts += type == kPngText;
                        const auto* checked = reinterpret_cast<const Bytef*>(data.data()) - 4; // with the type
                        const auto at = size_t(data.data() - file.data()) + data.size();
                        EXPECT_EQ(bigEndian(file, at), crc32(0, checked, uInt(data.size() + 4)));
                        return true;
                    });
    EXPECT_EQ(texts, kNotes.size());
}

/// `name` holds the first `bytes` of `whole`.
PictureState stateOf(const TemporaryFolder& folder, const std::string& name, const std::string& whole, size_t bytes)
{
    std::ofstream(folder / name, std::ios::binary) << whole.substr(0, bytes);
    return pictureState(folder / name, kWidth, kHeight);
}

TEST(PictureFile, IsWholeWithItsLastByteOnly)
{
    const TemporaryFolder folder;
    ASSERT_TRUE(writeExr(folder / "whole.exr", {kWidth, kHeight, numbers(3, 1)}));
    ASSERT_TRUE(writePng(folder / "whole.png", kWidth, kHeight, 3, std::vector<uint8_t>(3 * kWidth * kHeight, 77)));
    for (const std::string extension : {".exr", ".png"})
    {
        const std::string whole = fileBytes(folder / ("whole" + extension));
        for (size_t bytes = 0; bytes < whole.size(); bytes += bytes + 20 < whole.size() ? 41 : 1)
            ASSERT_EQ(stateOf(folder, "cut" + extension, whole, bytes), PictureState::kIncomplete)
                << extension << " " << bytes;
        EXPECT_EQ(stateOf(folder, "cut" + extension, whole, whole.size()), PictureState::kWhole) << extension;
        std::string holey = whole; // as a crash of the machine may leave it
        holey.replace(whole.size() / 2, std::string::npos, whole.size() - whole.size() / 2, '\0');
        EXPECT_EQ(stateOf(folder, "cut" + extension, holey, holey.size()), PictureState::kIncomplete) << extension;
    }
}

TEST(PictureFile, OfAnotherKindOrSizeIsNotMistaken)
{
    const TemporaryFolder folder;
    const std::vector<uint8_t> black(3 * 16);
    ASSERT_TRUE(writePng(folder / "a.png", 4, 4, 3, black));
    ASSERT_TRUE(writeExr(folder / "a.exr", {4, 4, std::vector<float>(3 * 16)}));
    EXPECT_EQ(pictureState(folder / "a.png", 4, 4), PictureState::kWhole);
    EXPECT_EQ(pictureState(folder / "a.png", 4, 5), PictureState::kOther);
    EXPECT_EQ(pictureState(folder / "a.exr", 4, 4), PictureState::kWhole);
    EXPECT_EQ(pictureState(folder / "a.exr", 5, 4), PictureState::kOther);
    std::filesystem::copy_file(folder / "a.exr", folder / "b.png");
    EXPECT_EQ(pictureState(folder / "b.png", 4, 4), PictureState::kOther);
    std::ofstream(folder / "text.exr") << "notes on frame 3";
    EXPECT_EQ(pictureState(folder / "text.exr", 4, 4), PictureState::kOther);
    std::filesystem::create_directory(folder / "folder.exr");
    EXPECT_EQ(pictureState(folder / "folder.exr", 4, 4), PictureState::kOther);
    EXPECT_EQ(pictureState(folder / "none.exr", 4, 4), PictureState::kNone);
}
TEST(WriteFile, IsRefusedWithTheSentenceThatWasThereBeforeTheWork)
{
    const TemporaryFolder folder;
    const std::vector<uint8_t> bytes{1, 2, 3};
    // No one can write to /proc, root included.
    for (const std::filesystem::path& path : {folder / "none" / "a", folder.path(), std::filesystem::path("/proc/a")})
    {
        const Status can = canWriteFile(path), written = writeFile(path, bytes);
        ASSERT_FALSE(can) << path;
        ASSERT_FALSE(written) << path;
        EXPECT_EQ(can.error().code, ExitCode::kIo);
        EXPECT_EQ(written.error().code, ExitCode::kIo);
        EXPECT_EQ(can.error().message, written.error().message);
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteFile, CanBeAskedForWithoutAnyChange)
{
    const TemporaryFolder folder;
    ASSERT_TRUE(canWriteFile(folder / "a"));
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    ASSERT_TRUE(writeFile(folder / "a", std::vector<uint8_t>{1, 2, 3}));
    ASSERT_TRUE(canWriteFile(folder / "a"));
    EXPECT_EQ(fileBytes(folder / "a"), "\1\2\3");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}
} // namespace
