// The rows of FORMAT.md about material fields agree with the list in material_fields.h.
#include "format/gpu_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace
{
std::string range(float least, float most)
{
    if (least == -gpu::kUnbounded)
        return "finite";
    return most == gpu::kUnbounded ? fmt::format("{} or more", least) : fmt::format("{} to {}", least, most);
}

std::vector<std::string> fieldRows()
{
    using gpu::kUnbounded;
    std::vector<std::string> rows;
#define NUMBER(word, type, name, default_, least, most, meaning) \
    rows.push_back(fmt::format("| {} | {} | {} | {} | {} |", 4 * word, #type, #name, range(least, most), meaning));
#define FLAGS(word, name, meaning) \
    rows.push_back(fmt::format("| {} | u32 | {} | known bits | {} |", 4 * word, #name, meaning));
#define TEXTURE(word, name, encoding, channels, feature, meaning) \
    rows.push_back(fmt::format("| {} | u32 | {} | in TREF or `FFFFFFFF` | {}{} |", 4 * word, #name, meaning, \
                               gpu::encoding == gpu::kEncodingSrgb ? ", sRGB" : ""));
    MATERIAL_FIELDS(NUMBER, FLAGS, TEXTURE)
#undef NUMBER
#undef FLAGS
#undef TEXTURE
    return rows;
}

TEST(FormatDocument, ListsEveryMaterialField)
{
    std::ifstream file(FORMAT_DOCUMENT);
    ASSERT_TRUE(file) << FORMAT_DOCUMENT;
    const std::string text = (std::stringstream() << file.rdbuf()).str();
    for (const std::string& row : fieldRows())
        EXPECT_NE(text.find(row + "\n"), std::string::npos) << "FORMAT.md lacks this row:\n" << row;
}
} // namespace
