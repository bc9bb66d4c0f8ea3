// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/dataset/soslam_folder.h"
#include "support/lists.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Boxes of frame 0, 1, ... with these ids each.
std::vector<LabelledBox> Boxes(const std::vector<std::vector<std::optional<int>>>& frames) {
  std::vector<LabelledBox> boxes;
  for (size_t frame = 0; frame < frames.size(); ++frame) {
    for (const auto& id : frames[frame]) {
      boxes.push_back({"", static_cast<int>(frame), "cup", 1.0, {0, 0, 1, 1}, id});
    }
  }
  return boxes;
}

class ObjectIdsTest : public testing::Test {
 protected:
  // The ids that are left.
  std::vector<int> Ids(const std::vector<std::vector<std::optional<int>>>& frames) {
    testing::internal::CaptureStdout();
    findings_.clear();
    boxes_ =
        SeparateUntrackedBoxes(Boxes(frames), listed_, "a/detections.csv", &left_out_, &findings_);
    printed_ = testing::internal::GetCapturedStdout();
    std::vector<int> ids;
    for (const LabelledBox& box : boxes_) {
      if (box.object_id) ids.push_back(*box.object_id);
    }
    return ids;
  }

  std::vector<ListedObject> listed_;
  std::vector<LabelledBox> boxes_;
  std::vector<LabelledBox> left_out_;
  std::vector<Finding> findings_;
  std::string printed_;
};

TEST_F(ObjectIdsTest, IdsOfTracksStay) {
  EXPECT_THAT(Ids({{0, 1}, {0, 2}}), ElementsAre(0, 1, 0, 2));
  EXPECT_THAT(Ids({{0, 0, 1}, {0, 1}}), ElementsAre(0, 0, 1, 0, 1));        // once only
  EXPECT_THAT(Ids({{0, 0, 1, 1}, {0, 0}}), ElementsAre(0, 0, 1, 1, 0, 0));  // so has another id
  EXPECT_THAT(Ids({{0}, {0}}), ElementsAre(0, 0));                          // one object
  EXPECT_TRUE(left_out_.empty());
  EXPECT_THAT(findings_, IsEmpty());
  EXPECT_EQ(printed_, "");
}

TEST_F(ObjectIdsTest, BoxesOfNoTrackAreLeftOutAndCounted) {
  EXPECT_THAT(Ids({{1, -1, -1}, {1, std::nullopt, -7}}), ElementsAre(1, 1));
  EXPECT_EQ(boxes_.size(), 2u);
  EXPECT_EQ(left_out_.size(), 4u);
  EXPECT_THAT(printed_, HasSubstr("detections.csv: 4 of 6 boxes have object_id -7, -1"));
}

TEST_F(ObjectIdsTest, ZeroIsNoTrackWhereItAloneIsOfSeveralBoxes) {
  EXPECT_THAT(Ids({{0, 0, 1}, {0, 0, 0, 1, 2}, {0}}), ElementsAre(1, 1, 2));
  EXPECT_EQ(left_out_.size(), 6u);
}

TEST_F(ObjectIdsTest, ATableWithoutTracksHasNoIds) {
  for (const auto& frames : std::vector<std::vector<std::vector<std::optional<int>>>>{
           {{-1, -1}, {-1, -2}}, {{0, 0}, {0, -1}}}) {
    EXPECT_THAT(Ids(frames), IsEmpty());
    EXPECT_EQ(boxes_.size(), 4u);
    const Finding finding = Only(findings_);
    EXPECT_THAT(finding.found, HasSubstr("detections.csv: all 4 boxes have object_id"));
    EXPECT_THAT(finding.remedy, HasSubstr("let association be estimated"));
  }
  EXPECT_TRUE(left_out_.empty());
}

TEST_F(ObjectIdsTest, ListedObjectsAreObjects) {
  listed_ = {{-1, "cup", std::nullopt, std::nullopt}, {0, "cup", std::nullopt, std::nullopt}};
  EXPECT_THAT(Ids({{-1, 0, 0}, {0, 0, -2}}), ElementsAre(-1, 0, 0, 0, 0));
}

DetectionRow Row(int object, const std::string& label, double score = 1.0) {
  return {"a.csv:2", 0, object, label, score, {0, 0, 1, 1}};
}

// The labels of the rows after a unification that changes so many.
std::vector<std::string> UnifiedLabels(std::vector<DetectionRow> rows, int changed) {
  EXPECT_EQ(UnifyLabels({}, &rows), changed);
  return Fields(rows, &DetectionRow::label);
}

TEST(TrackLabelsTest, MostRowsThenScoresThenNamesDecide) {
  EXPECT_THAT(UnifiedLabels(
                  {Row(1, "sofa", 0.1), Row(1, "couch"), Row(1, "sofa", 0.1), Row(2, "couch")}, 1),
              ElementsAre("sofa", "sofa", "sofa", "couch"));
  EXPECT_THAT(UnifiedLabels({Row(1, "couch", 0.4), Row(1, "sofa", 0.5)}, 1),
              ElementsAre("sofa", "sofa"));
  EXPECT_THAT(UnifiedLabels({Row(1, "sofa"), Row(1, "couch")}, 1), ElementsAre("couch", "couch"));
  EXPECT_THAT(UnifiedLabels({Row(1, "sofa"), Row(2, "couch")}, 0), ElementsAre("sofa", "couch"));
}

}  // namespace
}  // namespace soslam
