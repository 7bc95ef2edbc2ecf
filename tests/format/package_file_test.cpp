// Paths that are no packages, and writing that fails.
#include "format/temporary_file.h"
#include "tests/format/sample_package.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include <fstream>

namespace
{
struct PackageFile : testing::Test
{
    TemporaryFolder folder;

    std::filesystem::path file(const std::string& content) const
    {
        const std::filesystem::path path = folder.path() / "test.lumi";
        std::ofstream(path, std::ios::binary) << content;
        return path;
    }

    static void expectError(const std::filesystem::path& path, ExitCode code, const std::string& words)
    {
        const auto package = package::Package::open(path);
        ASSERT_FALSE(package);
        EXPECT_EQ(package.error().code, code) << package.error().message;
        EXPECT_NE(package.error().message.find(words), std::string::npos) << package.error().message;
        EXPECT_EQ(package.error().message.find('\n'), std::string::npos) << package.error().message;
    }

    size_t fileCount() const { return size_t(std::distance(std::filesystem::directory_iterator(folder.path()), {})); }
};
} // namespace

TEST_F(PackageFile, OpensFromDisk)
{
    const std::filesystem::path path = folder.path() / "sample.lumi";
    ASSERT_TRUE(SamplePackage().write(path));
    const auto package = package::Package::open(path);
    ASSERT_TRUE(package) << package.error().message;
    EXPECT_EQ(package->triangles().size(), 5u);
    EXPECT_EQ(fileCount(), 1u) << "no temporary may be left";
}

TEST_F(PackageFile, MissingFile)
{
    expectError(folder.path() / "none.lumi", ExitCode::kIo, "No such file");
}
TEST_F(PackageFile, Folder)
{
    expectError(folder.path(), ExitCode::kIo, "directory");
}
TEST_F(PackageFile, EmptyFile)
{
    expectError(file(""), ExitCode::kInvalid, "empty");
}
TEST_F(PackageFile, OtherFormat)
{
    expectError(file("PNG or whatever"), ExitCode::kInvalid, "not a Lumicut package");
}
TEST_F(PackageFile, GltfIsToldWhatToDo)
{
    expectError(file("glTF"), ExitCode::kInvalid, "lumicut-compile");
}
TEST_F(PackageFile, FirstBytesOnly)
{
    expectError(file("\xABLUM"), ExitCode::kInvalid, "truncated");
}

TEST_F(PackageFile, NamedPipeIsRefusedWithoutWaiting)
{
    const std::filesystem::path pipe = folder.path() / "pipe.lumi";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    expectError(pipe, ExitCode::kIo, "regular file");
}

TEST_F(PackageFile, WritingReplacesTheOldFileAtOnce)
{
    const std::filesystem::path path = file("old");
    ASSERT_TRUE(SamplePackage().write(path));
    EXPECT_TRUE(package::Package::open(path));
}

TEST_F(PackageFile, WritingIntoAMissingFolderIsAnIoError)
{
    const auto written = SamplePackage().write(folder.path() / "none" / "x.lumi");
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ExitCode::kIo);
}

TEST_F(PackageFile, WritingOverAFolderLeavesNothingBehind)
{
    std::filesystem::create_directory(folder.path() / "taken");
    const auto written = SamplePackage().write(folder.path() / "taken");
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ExitCode::kIo);
    EXPECT_EQ(fileCount(), 1u);
}

TEST_F(PackageFile, AnInterruptedProgramLeavesNoTemporaryBehind)
{
    for (const int signal : {SIGINT, SIGTERM})
    {
        const pid_t child = fork();
        if (child == 0)
        {
            removeTemporaryFilesOnSignals();
            const TemporaryFile done_before(folder.path() / "before");
            TemporaryFile a(folder.path() / "a"), b(folder.path() / "b");
            a.append(std::as_bytes(std::span("half", 4)));
            raise(signal);
            _exit(0);
        }
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
        EXPECT_EQ(fileCount(), 0u);
    }
}
