// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "dataset/kitti_object.h"
#include "support/expect_error.h"
#include "support/labelled_boxes.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class KittiBoxesTest : public testing::Test {
 protected:
  KittiBoxesTest() { std::filesystem::create_directory(folder_ / "Car"); }
  std::vector<LabelledBox> Read(const std::string& text) {
    WriteBytes(folder_ / "Car/0000.txt", text);
    return ReadKittiBoxes(folder_ / "Car/0000.txt");
  }
  TemporaryFolder folder_;
};

TEST_F(KittiBoxesTest, BadLinesAreNamed) {
  const BadTexts cases = {{"1,2,3,4,5", {"has 5 fields", "frame,x1,y1,x2,y2,score"}},
                          {"1 2 3 4 5 6", {"has 1 fields"}},
                          {"1.5,1,2,3,4,1", {"frame is '1.5'"}},
                          {"-1,1,2,3,4,1", {"frame is -1"}},
                          {"1,1,2,inf,4,1", {"x2 is 'inf'"}},
                          {"1,1,2,3,4,", {"score is ''"}},
                          {"1,10,2,3,4,1", {"box is 10 2 3 4", "x1 <= x2"}}};
  ExpectBadTexts(cases, "Car/0000.txt:2",
                 [&](const std::string& line) { Read("0,1,2,3,4,1\r\n" + line + "\r\n"); });
}

}  // namespace
}  // namespace soslam
