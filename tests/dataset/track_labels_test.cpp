// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dataset/object_table.h"

namespace soslam {
namespace {

using testing::ElementsAre;

DetectionRow Row(int object, const std::string& label, double score = 1.0) {
  return {"a.csv:2", 0, object, label, score, {0, 0, 1, 1}};
}

class TrackLabelsTest : public testing::Test {
 protected:
  std::vector<std::string> Labels(std::vector<DetectionRow> rows) {
    changed_ = UnifyLabels({}, &rows);
    std::vector<std::string> labels;
    for (const DetectionRow& row : rows) labels.push_back(row.label);
    return labels;
  }

  int changed_ = 0;
};

TEST_F(TrackLabelsTest, MostRowsThenScoresThenNamesDecide) {
  EXPECT_THAT(Labels({Row(1, "sofa", 0.1), Row(1, "couch"), Row(1, "sofa", 0.1), Row(2, "couch")}),
              ElementsAre("sofa", "sofa", "sofa", "couch"));
  EXPECT_EQ(changed_, 1);
  EXPECT_THAT(Labels({Row(1, "couch", 0.4), Row(1, "sofa", 0.5)}), ElementsAre("sofa", "sofa"));
  EXPECT_THAT(Labels({Row(1, "sofa"), Row(1, "couch")}), ElementsAre("couch", "couch"));
  EXPECT_THAT(Labels({Row(1, "sofa"), Row(2, "couch")}), ElementsAre("sofa", "couch"));
  EXPECT_EQ(changed_, 0);
}

}  // namespace
}  // namespace soslam
