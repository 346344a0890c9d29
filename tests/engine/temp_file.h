// A file in the directory for temporary files that goes when its object goes.
#ifndef GESTUS_TESTS_ENGINE_TEMP_FILE_H_
#define GESTUS_TESTS_ENGINE_TEMP_FILE_H_

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace gestus::test {

class TempFile {
 public:
  explicit TempFile(const std::vector<std::uint8_t>& content)
      : path_(testing::TempDir() + "gestus_XXXXXX") {
    const int fd = mkstemp(path_.data());
    EXPECT_GE(fd, 0);
    EXPECT_EQ(write(fd, content.data(), content.size()), static_cast<ssize_t>(content.size()));
    close(fd);
  }
  ~TempFile() { unlink(path_.c_str()); }
  TempFile(const TempFile&) = delete;
  TempFile& operator=(const TempFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace gestus::test

#endif  // GESTUS_TESTS_ENGINE_TEMP_FILE_H_
