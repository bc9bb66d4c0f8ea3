// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <opencv2/core/version.hpp>

#include "soslam/artefact/run_file.h"
#include "soslam/base/error.h"
#include "soslam/system/hash.h"
#include "support/edited_json.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public FolderTest {
 protected:
  int FilesInFolder() {
    return static_cast<int>(std::distance(fs::directory_iterator(folder_.path()), {}));
  }

  fs::path file = folder_ / "result.txt";
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
    EXPECT_EQ(atomic.TemporaryPath().parent_path(), folder_.path());
    EXPECT_FALSE(fs::exists(file));
    atomic.Commit();
  }
  EXPECT_EQ(FileBytes(file), "new");
  EXPECT_EQ(FilesInFolder(), 1);
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
  ExpectError<SettingsError>(
      [&] {
        const FileSizeLimit limit(1000);
        WriteTextFile(file, std::string(100000, 'x'));
      },
      {"result.txt: cannot be written", "File too large"});
  EXPECT_EQ(FileBytes(file), "old");
  EXPECT_EQ(FilesInFolder(), 1);
}

TEST_F(AtomicFileTest, UnusableTargetsAreRefused) {
  EXPECT_THROW(WriteTextFile(folder_ / "no such folder" / "result.txt", "x"), SettingsError);
  EXPECT_THROW(WriteTextFile(folder_.path(), "x"), SettingsError);
  EXPECT_EQ(FilesInFolder(), 0);
}

RunRecord SmallRecord() {
  RunRecord record;
  record.stage = "soslam-planes";
  record.software = ThisSoftware();
  record.settings = {{"count", {3, "default"}}, {"name", {"x", "command line"}}};
  record.allow_outside_paths = true;
  record.seed = 7;
  record.folders = {{"dataset", "data/room"}};
  record.inputs = {{"dataset", "dataset", "rgb/1.png", Sha256OfText("1")},
                   {"sequence", kRelativeToRun, "../import-1/sequence.json", Sha256OfText("2")},
                   {"", kRelativeToCall, "elsewhere.txt", Sha256OfText("3")}};
  record.outputs = {{"output", kRelativeToRun, "planes.json", Sha256OfText("4")}};
  record.timing = {{"wall_s", 1.5},
                   {"cpu_s", 2.5},
                   {"peak_memory_mb", 10.0},
                   {"threads", 2},
                   {"machine", {{"cpu", "A CPU"}, {"cores", 4}}}};
  return record;
}

class RunFileTest : public FolderTest {
 protected:
  std::filesystem::path file_ = folder_ / "run.json";
};

TEST_F(RunFileTest, ReadsWhatWasWritten) {
  WriteRun(file_, SmallRecord());
  const std::string bytes = FileBytes(file_);
  const RunRecord record = ReadRun(file_);
  EXPECT_EQ(record.stage, "soslam-planes");
  EXPECT_EQ(record.software, ThisSoftware());
  EXPECT_EQ(record.settings->at("count").value, 3);
  EXPECT_EQ(record.settings->at("name").origin, "command line");
  EXPECT_TRUE(record.allow_outside_paths);
  EXPECT_EQ(record.inputs.at(1).path, "../import-1/sequence.json");
  WriteRun(file_, record);
  EXPECT_EQ(FileBytes(file_), bytes);
}

TEST_F(RunFileTest, RefusesDamagedRecordsByName) {
  WriteRun(file_, SmallRecord());
  ExpectEditsRefused(file_,
                     {{"/inputs", nullptr, "inputs"},
                      {"/inputs/0/sha256", "\"ABC\"", "/inputs/0: sha256 is"},
                      {"/inputs/0/relative_to", "\"nowhere\"", "/inputs/0/relative_to"},
                      {"/outputs/0/relative_to", "\"table\"", "/outputs/0/relative_to"},
                      {"/settings/count/origin", "\"fate\"", "/settings/count: origin is"},
                      {"/exit_code", "-1", "exit_code"},
                      {"/stage", "\"rm -r\"", "stage"},
                      {"/artefact/kind", "\"map\"", "expected \"run\""},
                      {"/artefact/schema_version", "[9, 0]", "version [9, 0]"}},
                     [&] { ReadRun(file_); });
  WriteBytes(file_, "{");
  ExpectError<InputError>([&] { ReadRun(file_); }, {"run.json"});
}

}  // namespace
}  // namespace soslam
