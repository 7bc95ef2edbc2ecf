#include "compiler/gltf_uri.h"
#include "tests/compiler/gltf_builder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace
{
/// A folder in which each file holds its own name.
class Uri : public testing::Test
{
protected:
    void make(const std::string& name)
    {
        std::filesystem::create_directories((folder_ / name).parent_path());
        writeBytes(folder_ / name, name.data(), name.size());
    }

    /// The name of the file that `uri` leads to, or "error" and the exit code.
    std::string found(const std::string& uri) const
    {
        InputFiles files(folder_.path());
        const auto bytes = readUri(uri, files);
        return bytes ? std::string(bytes->begin(), bytes->end()) : fmt::format("error {}", int(bytes.error().code));
    }

    TemporaryFolder folder_;
};

TEST_F(Uri, NamesAreTakenPercentEncodedOrAsTheyAre)
{
    make("maps/a b.png");
    make("maps/my%20wall.png");
    make("no#1.png");
    make("a+b.png");
    make("Wände.png");
    EXPECT_EQ(found("maps/a%20b.png"), "maps/a b.png");
    EXPECT_EQ(found("./maps/../maps/a b.png"), "maps/a b.png");
    EXPECT_EQ(found("maps/my%20wall.png"), "maps/my%20wall.png");
    EXPECT_EQ(found("no%231.png"), "no#1.png");
    EXPECT_EQ(found("no#1.png"), "no#1.png");
    EXPECT_EQ(found("a+b.png"), "a+b.png");
    EXPECT_EQ(found("W%C3%A4nde.png"), "Wände.png");
    EXPECT_EQ(found("maps/gone.png"), "error 2");
    EXPECT_EQ(found("maps"), "error 2");
    EXPECT_EQ(found(""), "error 3");
    EXPECT_EQ(found("a%00b"), "error 3");
}

TEST_F(Uri, TheEncodedNameComesBeforeTheLiteralOne)
{
    make("a b.png");
    make("a%20b.png");
    EXPECT_EQ(found("a%20b.png"), "a b.png");
    EXPECT_EQ(found("a%2520b.png"), "a%20b.png");
}

TEST_F(Uri, BackslashesAreSlashes)
{
    make("maps/tiles/wall.png");
    make("odd\\name.png");
    EXPECT_EQ(found("maps\\tiles\\wall.png"), "maps/tiles/wall.png");
    EXPECT_EQ(found("maps%5Ctiles%5cwall.png"), "maps/tiles/wall.png");
    EXPECT_EQ(found("odd\\name.png"), "odd\\name.png");
}

TEST_F(Uri, QueriesAndFragmentsAreNoPartOfTheName)
{
    make("wall.png");
    make("b?c.png");
    EXPECT_EQ(found("wall.png?v=3"), "wall.png");
    EXPECT_EQ(found("wall.png#top"), "wall.png");
    EXPECT_EQ(found("b?c.png"), "b?c.png");
}

TEST_F(Uri, FileUrisAreLocalPaths)
{
    make("my wall.png");
    const std::string path = folder_.path().string();
    for (const char* scheme : {"file://", "FILE://", "file://localhost", "file:"})
        EXPECT_EQ(found(scheme + path + "/my%20wall.png"), "my wall.png") << scheme;
    EXPECT_EQ(found("file:my%20wall.png"), "my wall.png");
    EXPECT_EQ(found("file://server" + path + "/my%20wall.png"), "error 5");
    EXPECT_EQ(found("file:///nowhere/wall.png"), "error 2");
    EXPECT_EQ(found("https://example.org/wall.png"), "error 5");
}

TEST_F(Uri, AnotherCaseIsTheLastTry)
{
    make("maps/wall.png");
    make("maps/Wall.PNG");
    make("maps/floor.png");
    EXPECT_EQ(found("maps/Wall.PNG"), "maps/Wall.PNG");
    EXPECT_EQ(found("Maps\\FLOOR.png"), "maps/floor.png");
    EXPECT_EQ(found("MAPS/WALL.png"), "error 2"); // two have that name
}

TEST_F(Uri, DataUrisMayBeSpelledInEveryWay)
{
    for (const char* uri : {"data:image/png;base64,SGk+Pz8=", "data:image/png;BASE64,SGk+Pz8=", "DATA:;base64,SGk+Pz8",
                            "data:image/png;charset=utf-8;base64,SGk+Pz8=", "data:image/png;base64,SG\r\nk+\n Pz8=\n",
                            "data:;base64,SGk-Pz8=", "data:;base64,SGk%2BPz8%3D", "data:image/png ; base64,SGk+Pz8="})
        EXPECT_EQ(found(uri), "Hi>??") << uri;
    for (const char* uri : {"data:image/png;base64", "data:image/png,SGk=", "data:;base64,SG*k", "data:;base64,S=Gk"})
        EXPECT_EQ(found(uri), "error 3") << uri;
}
} // namespace
