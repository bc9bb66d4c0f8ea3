// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/object_table.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

using testing::ElementsAre;

DetectionRow Row(int object, const std::string& label, double score = 1.0) {
  return {"a.csv:2", 0, object, label, score, {0, 0, 1, 1}};
}

class TrackLabelsTest : public testing::Test {
 protected:
  std::vector<std::string> Labels(std::vector<DetectionRow> rows) {
    changed_ = UnifyLabels(listed_, &rows);
    std::vector<std::string> labels;
    for (const DetectionRow& row : rows) labels.push_back(row.label);
    return labels;
  }

  std::vector<ListedObject> listed_;
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

TEST_F(TrackLabelsTest, ListedObjectsKeepTheirLabel) {
  listed_ = {{1, "sofa", std::nullopt, std::nullopt}, {7, "cup", std::nullopt, std::nullopt}};
  EXPECT_THAT(Labels({Row(1, "sofa", 0.1), Row(1, "couch")}), ElementsAre("sofa", "sofa"));
  ExpectError<InputError>(
      [&] {
        Labels({Row(1, "sofa"), Row(1, "couch"), Row(1, "bench")});
      },
      {"a.csv:2", "label of object 1 is 'couch'", "2 of its 3 boxes", "'sofa'", "objects.json"});
}

}  // namespace
}  // namespace soslam
