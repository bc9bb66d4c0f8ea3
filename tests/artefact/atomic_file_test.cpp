// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>

#include "base/error.h"
#include "support/dataset_fixture.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
 protected:
  int FilesInFolder() {
    return static_cast<int>(std::distance(fs::directory_iterator(folder), {}));
  }

  fs::path folder = FreshTestFolder();
  fs::path file = folder / "result.txt";
};

// Files of this process cannot grow beyond `bytes` while it lives: what a full disk looks like.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &old_limit_);
    const rlimit limit{bytes, old_limit_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    old_handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_limit_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_limit_;
  void (*old_handler_)(int);
};

TEST_F(AtomicFileTest, AppearsOnlyWhenCommitted) {
  {
    AtomicFile atomic(file);
    std::ofstream(atomic.TemporaryPath()) << "new";
    EXPECT_EQ(atomic.TemporaryPath().parent_path(), folder);
    EXPECT_FALSE(fs::exists(file));
    atomic.Commit();
  }
  EXPECT_EQ(FileBytes(file), "new");
  EXPECT_EQ(FilesInFolder(), 1);
}

TEST_F(AtomicFileTest, WithoutCommitTheOldFileStays) {
  WriteTextFile(file, "old");
  {
    AtomicFile atomic(file);
    std::ofstream(atomic.TemporaryPath()) << "half-wri";
  }
  EXPECT_EQ(FileBytes(file), "old");
  EXPECT_EQ(FilesInFolder(), 1);
}

TEST_F(AtomicFileTest, ReplacesOtherContent) {
  WriteTextFile(file, "old and longer");
  WriteTextFile(file, "new");
  EXPECT_EQ(FileBytes(file), "new");
  WriteTextFile(file, "");
  EXPECT_EQ(FileBytes(file), "");
}

TEST_F(AtomicFileTest, IdenticalContentKeepsItsTime) {
  WriteTextFile(file, "same");
  const auto long_ago = fs::last_write_time(file) - std::chrono::hours(5);
  fs::last_write_time(file, long_ago);
  WriteTextFile(file, "same");
  EXPECT_EQ(fs::last_write_time(file), long_ago);
  WriteTextFile(file, "samf");
  EXPECT_NE(fs::last_write_time(file), long_ago);
  EXPECT_EQ(FilesInFolder(), 1);
}

TEST_F(AtomicFileTest, FullDiskLeavesTheOldFile) {
  WriteTextFile(file, "old");
  std::string message;
  {
    const FileSizeLimit limit(1000);
    try {
      WriteTextFile(file, std::string(100000, 'x'));
    } catch (const SettingsError& error) {
      message = error.what();
    }
  }
  EXPECT_THAT(message, testing::AllOf(testing::HasSubstr("result.txt: cannot be written"),
                                      testing::HasSubstr("File too large")));
  EXPECT_EQ(FileBytes(file), "old");
  EXPECT_EQ(FilesInFolder(), 1);
}

TEST_F(AtomicFileTest, UnusableTargetsAreRefused) {
  EXPECT_THROW(WriteTextFile(folder / "no such folder" / "result.txt", "x"), SettingsError);
  EXPECT_THROW(WriteTextFile(folder, "x"), SettingsError);
  EXPECT_EQ(FilesInFolder(), 0);
}

}  // namespace
}  // namespace soslam
