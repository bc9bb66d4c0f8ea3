// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/yolo_boxes.h"
#include "support/expect_error.h"
#include "support/run_command.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

class YoloTextsTest : public testing::Test {
 protected:
  void Write(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    WriteBytes(folder_ / name, text);
  }
  fs::path Pack() {
    EXPECT_EQ(RunCommand({"tar", "czf", (folder_ / "labels.tar.gz").string(), "-C",
                          folder_.path().string(), "packed"})
                  .exit_code,
              0);
    return folder_ / "labels.tar.gz";
  }
  static std::vector<std::string> Images(const YoloTexts& texts) {
    std::vector<std::string> images;
    for (const YoloText& text : texts.images) images.push_back(text.image);
    return images;
  }
  TemporaryFolder folder_;
};

TEST_F(YoloTextsTest, ExtrasOfToolsAreLeftOut) {
  Write("labels/1.txt", "0 0.1 0.1 0.1 0.1\n");
  Write("labels/train.txt", "0 0.1 0.1 0.1 0.1\n");  // an image of that name
  Write("labels/val.txt", "data/obj_train_data/1.jpg\n");
  Write("labels/classes.txt", "cup\nbook\n");
  Write("labels/._1.txt", std::string("\0\5\x16\7Mac OS X", 12));
  Write("labels/.DS_Store", "x");
  Write("labels/README.roboflow.txt", "Exported\n");
  const YoloTexts texts = ReadYoloTexts(folder_ / "labels");
  EXPECT_THAT(Images(texts), ElementsAre("1", "train"));
  EXPECT_FALSE(texts.names);  // FindLabelFile finds those of folders
}

TEST_F(YoloTextsTest, ArchivesOfCvatAndMacOs) {
  Write("packed/obj_train_data/1.txt", "0 0.1 0.1 0.1 0.1\n");
  Write("packed/train.txt", "data/obj_train_data/1.jpg\n");
  Write("packed/obj.data", "classes = 2\n");
  Write("packed/obj.names", "cup\nbook\n");
  Write("packed/__MACOSX/obj_train_data/._1.txt", std::string("\0\5\x16\7Mac OS X", 12));
  Write("packed/__MACOSX/obj.names", "no\n");
  const YoloTexts texts = ReadYoloTexts(Pack());
  EXPECT_THAT(Images(texts), ElementsAre("1"));
  ASSERT_TRUE(texts.names);
  EXPECT_THAT(*texts.names, ElementsAre("cup", "book"));
  EXPECT_THAT(texts.names_place, testing::EndsWith("labels.tar.gz/packed/obj.names"));
}

TEST_F(YoloTextsTest, NothingToReadAndTwoOfOneNameAreNamed) {
  fs::create_directories(folder_ / "labels");
  ExpectError<InputError>([&] { ReadYoloTexts(folder_ / "labels"); }, {"labels", "no *.txt"});
  ExpectError<InputError>([&] { ReadYoloTexts(folder_ / "none"); }, {"none", "is missing"});
  Write("packed/a/1.txt", "");
  Write("packed/b/1.txt", "");
  ExpectError<InputError>([&] { ReadYoloTexts(Pack()); }, {"labels.tar.gz", "several files 1.txt"});
}

}  // namespace
}  // namespace soslam
