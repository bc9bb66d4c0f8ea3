// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/dataset_folder.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/folder_test.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

class DatasetFolderTest : public FolderTest {
 protected:
  void WriteDataset(const std::string& list = "1.png\n") {
    DatasetFolder output(dataset_, "soslam-test");
    output.Write("README.md", output.Mark() + ". -->\n");
    output.Write("rgb.txt", list);
    fs::create_directory(output.Temporary() / "rgb");
    output.Write("rgb/1.png", "pixels");
    output.Commit();
  }
  void ExpectRefused(const std::vector<std::string>& words) {
    ExpectError<SettingsError>([&] { WriteDataset(); }, words);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "nothing is left";
  }

  fs::path dataset_ = folder_ / "room";
};

TEST_F(DatasetFolderTest, AnUnchangedDatasetIsReplaced) {
  WriteDataset();
  Write("room/run.json", "{}");  // of the run
  Write("room/timing.json", "{}");
  fs::remove(dataset_ / "rgb/1.png");  // nothing of it can be lost
  WriteDataset("other\n");
  EXPECT_EQ(FileBytes(dataset_ / "rgb.txt"), "other\n");
  EXPECT_EQ(FileBytes(dataset_ / "rgb/1.png"), "pixels");
  EXPECT_FALSE(fs::exists(dataset_ / "run.json"));
}

TEST_F(DatasetFolderTest, FilesOfOthersAreNeverLost) {
  WriteDataset();
  for (const char* name : {"notes.txt", "rgb/mine.jpg", "rgb/run.json", "deep/er/notes.txt"}) {
    Write(std::string("room/") + name, "by hand");
    ExpectRefused({dataset_.string(), std::string(name) + ", which is of others", "lost"});
    EXPECT_EQ(FileBytes(dataset_ / name), "by hand");
    fs::remove(dataset_ / name);
  }
  fs::create_directory_symlink(folder_.path(), dataset_ / "link");
  ExpectRefused({"link", "lost"});
  fs::remove(dataset_ / "link");
  EXPECT_NO_THROW(WriteDataset());
}

TEST_F(DatasetFolderTest, ChangedFilesAreNeverLost) {
  for (const char* name : {"rgb.txt", "README.md", "rgb/1.png"}) {
    WriteDataset();
    const std::string before = FileBytes(dataset_ / name);
    WriteBytes(dataset_ / name, before + "by hand");
    ExpectRefused({dataset_.string(), std::string(name) + ", which was changed", "lost"});
    EXPECT_EQ(FileBytes(dataset_ / name), before + "by hand");
    WriteBytes(dataset_ / name, before);
  }
  EXPECT_NO_THROW(WriteDataset());
}

TEST_F(DatasetFolderTest, FilesThatComeDuringTheRunAreNotLost) {
  WriteDataset();
  DatasetFolder output(dataset_, "soslam-test");
  output.Write("README.md", output.Mark() + ". -->\n");
  Write("room/notes.txt", "by hand");
  ExpectError<SettingsError>([&] { output.Commit(); }, {"notes.txt", "lost"});
  EXPECT_EQ(FileBytes(dataset_ / "notes.txt"), "by hand");
}

TEST_F(DatasetFolderTest, FoldersOfOtherWritersAreRefused) {
  fs::create_directory(dataset_);
  Write("room/run.json", "{}");  // of a run that failed
  EXPECT_NO_THROW(WriteDataset());
  fs::remove(dataset_ / "SHA256SUMS");
  ExpectRefused({dataset_.string(), "not written by soslam-test"});
  fs::remove_all(dataset_);
  Write("room/README.md", "# My dataset\n");
  ExpectRefused({dataset_.string(), "not written by soslam-test"});
}

}  // namespace
}  // namespace soslam
