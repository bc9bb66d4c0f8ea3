// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "dataset/class_names.h"
#include "dataset/labelled_box.h"
#include "support/expect_error.h"
#include "support/labelled_boxes.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class OaSlamBoxesTest : public testing::Test {
 protected:
  std::vector<LabelledBox> Read(const std::string& text) {
    WriteBytes(folder_ / "boxes.json", text);
    return ReadOaSlamBoxes(folder_ / "boxes.json", CocoLabels());
  }
  TemporaryFolder folder_;
};

TEST_F(OaSlamBoxesTest, BadFilesAreNamed) {
  const auto detection = [](const std::string& fields) {
    return R"([{"file_name": "a.png", "detections": []},
               {"file_name": "b.png", "detections": [{)" +
           fields + "}]}]";
  };
  const std::string where = "boxes.json#/1/detections/0";
  const BadTexts cases = {
      {"{}", {"boxes.json", "not a list"}},
      {R"([{"detections": []}])", {"boxes.json#/0", "file_name is missing"}},
      {R"([{"file_name": "a.png", "detections": 3}])", {"boxes.json#/0", "detections is 3"}},
      {detection(R"("category_id": 80, "detection_score": 1, "bbox": [1, 2, 3, 4])"),
       {where, "category_id is 80", "0 to 79"}},
      {detection(R"("category_id": -1, "detection_score": 1, "bbox": [1, 2, 3, 4])"),
       {where, "category_id is -1"}},
      {detection(R"("category_id": 1, "bbox": [1, 2, 3, 4])"),
       {where, "detection_score is missing"}},
      {detection(R"("category_id": 1, "detection_score": 1, "bbox": [1, 2, "3", 4])"),
       {where, "bbox is [1,2,\"3\",4]"}},
      {detection(R"("category_id": 1, "detection_score": 1, "bbox": [300, 68, 59, 97])"),
       {where, "x1 <= x2"}}};
  ExpectBadTexts(cases, "boxes.json", [&](const std::string& text) { Read(text); });
}

}  // namespace
}  // namespace soslam
