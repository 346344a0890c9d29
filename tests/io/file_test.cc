// Outputs appear complete or not at all.
#include "models/io/file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace gestus {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "gestus-file-test-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  static std::string Content(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }
  static Status Put(const std::string& path, const std::string& text) {
    auto file = AtomicFile::Create(path);
    if (!file.ok()) return file.status();
    GESTUS_RETURN_IF_ERROR(file->Write(text.data(), text.size()));
    return file->Commit();
  }
  std::size_t Files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(AtomicFileTest, CreatesAndReplaces) {
  ASSERT_TRUE(Put(Path("out"), "first").ok());
  EXPECT_EQ(Content(Path("out")), "first");
  ASSERT_TRUE(Put(Path("out"), "second").ok());
  EXPECT_EQ(Content(Path("out")), "second");
  EXPECT_EQ(Files(), 1U);
}

TEST_F(AtomicFileTest, WithoutCommitNothingChanges) {
  ASSERT_TRUE(Put(Path("out"), "old").ok());
  for (const char* name : {"out", "new"}) {
    auto file = AtomicFile::Create(Path(name));
    ASSERT_TRUE(file.ok());
    ASSERT_TRUE(file->Write("half", 4).ok());
    EXPECT_EQ(Content(Path("out")), "old");
  }
  EXPECT_EQ(Content(Path("out")), "old");
  EXPECT_EQ(Files(), 1U);
}

TEST_F(AtomicFileTest, KeepsModeAndFollowsLinks) {
  ASSERT_TRUE(Put(Path("out"), "old").ok());
  ASSERT_EQ(::chmod(Path("out").c_str(), 0640), 0);
  fs::create_symlink("out", Path("link"));
  ASSERT_TRUE(Put(Path("link"), "new").ok());
  EXPECT_TRUE(fs::is_symlink(Path("link")));
  EXPECT_EQ(Content(Path("out")), "new");
  struct stat info = {};
  ASSERT_EQ(::stat(Path("out").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 07777U, 0640U);
}

TEST_F(AtomicFileTest, RemovesWhatAKilledRunLeft) {
  ASSERT_TRUE(Put(Path("out"), "old").ok());
  std::ofstream(Path("out.gestus-part")) << "left behind";
  ASSERT_TRUE(Put(Path("out"), "new").ok());
  EXPECT_EQ(Content(Path("out")), "new");
  EXPECT_EQ(Files(), 1U);
}

TEST_F(AtomicFileTest, RefusesDirectoriesAndMissingOnes) {
  EXPECT_EQ(AtomicFile::Create(folder_.string()).status().message(),
            "is a directory, expected the name of a file to write");
  EXPECT_FALSE(AtomicFile::Create(Path("no/such/out")).ok());
  EXPECT_FALSE(AtomicFile::Create("").ok());
  EXPECT_FALSE(AtomicFile::Create(Path(std::string(300, 'n'))).ok());
  EXPECT_EQ(Files(), 0U);
}

TEST_F(AtomicFileTest, FullDeviceIsAnErrorAndStaysADevice) {
  const Status status = Put("/dev/full", "x");
  EXPECT_EQ(status.message(), "cannot be written: No space left on device");
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_TRUE(Put("/dev/null", "x").ok());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(AtomicFileTest, SizeLimitLeavesTheOldFile) {
  ASSERT_TRUE(Put(Path("out"), "old").ok());
  auto* before = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  rlimit limit = old_limit;
  limit.rlim_cur = 4096;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  const Status status = Put(Path("out"), std::string(100000, 'x'));
  ::setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, before);
  EXPECT_EQ(status.message(), "cannot be written: File too large");
  EXPECT_EQ(Content(Path("out")), "old");
  EXPECT_EQ(Files(), 1U);
}

TEST(OpenInput, RefusesWhatIsNoFile) {
  EXPECT_EQ(OpenInput("/").status().message(), "is a directory, expected a file");
  EXPECT_EQ(OpenInput("/dev/null").status().message(), "is a pipe or device, expected a file");
  EXPECT_EQ(OpenInput("/no/such").status().message(),
            "cannot be opened (No such file or directory), expected a readable file");
}

}  // namespace
}  // namespace gestus
