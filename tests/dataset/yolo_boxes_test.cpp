// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/yolo_boxes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/labelled_boxes.h"
#include "support/lists.h"
#include "support/run_command.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

class YoloTextsTest : public FolderTest {
 protected:
  fs::path Pack() {
    EXPECT_EQ(RunCommand({"tar", "czf", (folder_ / "labels.tar.gz").string(), "-C",
                          folder_.path().string(), "packed"})
                  .exit_code,
              0);
    return folder_ / "labels.tar.gz";
  }
};

TEST_F(YoloTextsTest, ExtrasOfToolsAreLeftOut) {
  Write("labels/1.txt", "0 0.1 0.1 0.1 0.1\n");
  Write("labels/train.txt", "0 0.1 0.1 0.1 0.1\n");  // an image of that name
  Write("labels/val.txt", "data/obj_train_data/1.jpg\n");
  Write("labels/classes.txt", "cup\nbook\n");
  Write("labels/labels.txt", "cup\nbook\n");
  Write("labels/._1.txt", std::string("\0\5\x16\7Mac OS X", 12));
  Write("labels/.DS_Store", "x");
  Write("labels/README.roboflow.txt", "Exported\n");
  const YoloTexts texts = ReadYoloTexts(folder_ / "labels");
  EXPECT_THAT(Fields(texts.images, &YoloText::image), ElementsAre("1", "train"));
  EXPECT_TRUE(texts.names.empty());  // FindLabelFiles finds those of folders
}

TEST_F(YoloTextsTest, ArchivesOfCvatAndMacOs) {
  Write("packed/obj_train_data/1.txt", "0 0.1 0.1 0.1 0.1\n");
  Write("packed/train.txt", "data/obj_train_data/1.jpg\n");
  Write("packed/obj.data", "classes = 2\n");
  Write("packed/obj.names", "cup\nbook\n");
  Write("packed/__MACOSX/obj_train_data/._1.txt", std::string("\0\5\x16\7Mac OS X", 12));
  Write("packed/__MACOSX/obj.names", "no\n");
  const YoloTexts texts = ReadYoloTexts(Pack());
  EXPECT_THAT(Fields(texts.images, &YoloText::image), ElementsAre("1"));
  const ClassNames names = Only(texts.names);
  EXPECT_THAT(names.names, ElementsAre("cup", "book"));
  EXPECT_THAT(names.place, testing::EndsWith("labels.tar.gz/packed/obj.names"));
}

TEST_F(YoloTextsTest, NothingToReadAndTwoOfOneNameAreNamed) {
  fs::create_directories(folder_ / "labels");
  ExpectError<InputError>([&] { ReadYoloTexts(folder_ / "labels"); }, {"labels", "no *.txt"});
  Write("labels/train/1.txt", "");
  ExpectError<InputError>([&] { ReadYoloTexts(folder_ / "labels"); }, {"it has folders: train"});
  ExpectError<InputError>([&] { ReadYoloTexts(folder_ / "none"); }, {"none", "is missing"});
  Write("packed/a/1.txt", "");
  Write("packed/b/1.txt", "");
  ExpectError<InputError>([&] { ReadYoloTexts(Pack()); }, {"labels.tar.gz", "several files 1.txt"});
}

using Extras = std::vector<std::vector<double>>;

// Rows of an image each, with these extras.
std::vector<YoloRow> Rows(const Extras& extras) {
  std::vector<YoloRow> rows;
  for (const auto& numbers : extras) {
    const std::string name = std::to_string(rows.size());
    rows.push_back({{name + ".txt:1", name, "cup", 1.0, {}}, numbers});
  }
  return rows;
}

// Scores and tracks of rows with these extras.
auto Read(const Extras& extras) {
  std::vector<YoloRow> rows = Rows(extras);
  ReadYoloExtras(&rows);
  return Fields(rows,
                [](const YoloRow& row) { return std::pair(row.box.score, row.box.object_id); });
}

TEST(YoloColumnsTest, ExtrasAreConfidencesOrTracks) {
  using ScoresAndTracks = std::vector<std::pair<double, std::optional<int>>>;
  constexpr std::optional<int> kNoTrack;
  for (const auto& [extras, expected] : std::vector<std::pair<Extras, ScoresAndTracks>>{
           // One extra is a confidence if all can be, or else a track.
           {{{0.5}, {1}, {}, {0}}, {{0.5, kNoTrack}, {1, kNoTrack}, {1, kNoTrack}, {0, kNoTrack}}},
           {{{1}, {1}}, {{1, kNoTrack}, {1, kNoTrack}}},
           {{{1}, {-1}, {2}, {}, {1}}, {{1, 1}, {1, -1}, {1, 2}, {1, kNoTrack}, {1, 1}}},
           // Two extras are in either order, Ultralytics' where both can be.
           {{{0.5, 3}, {1, 2}, {0.25}, {}}, {{0.5, 3}, {1, 2}, {0.25, kNoTrack}, {1, kNoTrack}}},
           {{{3, 0.5}, {2, 1}}, {{0.5, 3}, {1, 2}}},
           {{{1, 0}, {0, 1}}, {{1, 0}, {0, 1}}}}) {
    EXPECT_EQ(Read(extras), expected) << testing::PrintToString(extras);
  }
}

TEST(YoloColumnsTest, ContradictionsAreNamed) {
  const auto refused = [](const Extras& extras, const std::vector<std::string>& words) {
    ExpectError<InputError>([&] { Read(extras); }, words);
  };
  refused({{0.5}, {3}}, {"1.txt:1", "sixth number 3", "confidence from 0 to 1"});
  refused({{0.5}, {1.5}}, {"1.txt:1", "1.5"});
  refused({{3}, {-2}}, {"0.txt:1", "3"});
  refused({{0.5, 3}, {2, 0.5}}, {"1.txt:1", "2 0.5", "one order"});
  refused({{0.2, 0.3}, {0.4, 0.5}}, {"0.txt:1", "0.2 0.3", "segmentation"});
  refused({{0.5, 3}, {4}}, {"1.txt:1", "sixth number 4", "beside a track"});
}

TEST(YoloColumnsTest, NoImageHasATrackTwice) {
  auto rows = Rows({{97}, {88}, {97}});
  rows[2].box.frame = rows[0].box.frame;
  ExpectError<InputError>([&] { ReadYoloExtras(&rows); }, {"2.txt:1", "97 twice in one image"});
}

const std::vector<std::string> kLabels = {"cup", "teddy bear", "book"};

class YoloBoxesTest : public FolderTest {
 protected:
  std::vector<LabelledBox> Normalised() {
    return ReadNormalisedYoloBoxes(ReadYoloTexts(folder_.path()), kLabels, 640, 480, &mended_);
  }
  RejectionCounts mended_;
};

TEST_F(YoloBoxesTest, BadLinesAreNamed) {
  const BadTexts cases = {
      {"0 0.1 0.1 0.1", {"has 4 numbers", "class cx cy w h [score] [track]"}},
      {"0 0.1 0.1 0.1 0.1 0.5 0.5", {"has 7 numbers", "0.5 0.5", "track", "segmentation"}},
      {"0 0.1 0.1 0.1 0.1 0.5 0.5 0.2 0.2", {"has 9 numbers", "segmentation", "save boxes"}},
      {"3 0.1 0.1 0.1 0.1", {"class is 3", "0 to 2"}},
      {"-1 0.1 0.1 0.1 0.1", {"class is -1"}},
      {"cup 0.1 0.1 0.1 0.1", {"class is 'cup'"}},
      {"0 0.1 0.1 nan 0.1", {"w is 'nan'"}},
      {"0 0.1 0.1 0.1 0.1 high", {"number 6 is 'high'"}},
      {"0 0.1 0.1 0.1 -0.1", {"has -0.1", "fractions"}},
      {"0 218 246 65 94 0.4", {"has 218", "fractions"}}};
  ExpectBadTexts(cases, "a.txt:2", [&](const std::string& line) {
    Write("a.txt", "0 0.1 0.1 0.1 0.1\n" + line + "\n");
    Normalised();
  });
}

TEST_F(YoloBoxesTest, BadPixelLinesAreNamed) {
  const BadTexts cases = {{"0 1 2 3", {"has 4 numbers", "class x y w h [score] [track]"}},
                          {"0 100 100 -5 20", {"size is -5 x 20"}},
                          {"0 0.5 0.25 0.125 0.5", {"at most 1", "pixels"}}};
  ExpectBadTexts(cases, "a.txt:1", [&](const std::string& line) {
    Write("a.txt", line);
    ReadPixelYoloBoxes(ReadYoloTexts(folder_.path()), kLabels);
  });
}

TEST_F(YoloBoxesTest, BoxesALittleOutsideAreCutAndCounted) {
  Write("a.txt",
        "0 0.5 0.5 1.04 0.9\n0 0.98 -0.01 0.1 0.06\n0 0.5 0.5 1.0005 1\n0 0.9 0.5 0.4 0.2\n");
  const auto boxes = Normalised();
  ExpectBox(boxes[0].box, {-0.5, 0.05 * 480 - 0.5, 639.5, 0.95 * 480 - 0.5});
  ExpectBox(boxes[1].box, {0.93 * 640 - 0.5, -0.5, 639.5, 0.02 * 480 - 0.5});
  ExpectBox(boxes[2].box, {-0.5, -0.5, 639.5, 479.5});  // rounding
  ExpectBox(boxes[3].box, {0.7 * 640 - 0.5, 0.4 * 480 - 0.5, 1.1 * 640 - 0.5, 0.6 * 480 - 0.5});
  EXPECT_EQ(mended_, (RejectionCounts{{"cut_to_image", 2}}));
  Write("a.txt", "0 0.5 0.5 1.06 0.9\n");
  ExpectError<InputError>([&] { Normalised(); }, {"a.txt:1", "has 1.06", "fractions"});
}

}  // namespace
}  // namespace soslam
