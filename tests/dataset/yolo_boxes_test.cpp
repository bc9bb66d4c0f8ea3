// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/yolo_boxes.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/expect_error.h"
#include "support/labelled_boxes.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

const std::vector<std::string> kLabels = {"cup", "teddy bear", "book"};

class YoloBoxesTest : public testing::Test {
 protected:
  std::vector<LabelledBox> Normalised() {
    return ReadNormalisedYoloBoxes(ReadYoloTexts(folder_.path()), kLabels, 640, 480, &mended_);
  }
  std::vector<LabelledBox> Pixels() {
    return ReadPixelYoloBoxes(ReadYoloTexts(folder_.path()), kLabels);
  }
  void Write(const std::string& name, const std::string& text) { WriteBytes(folder_ / name, text); }

  TemporaryFolder folder_;
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
    Pixels();
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
