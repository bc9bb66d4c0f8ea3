// SPDX-License-Identifier: BSD-3-Clause
#include "model/occlusion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/level_sequence.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// What the tests tell boxes apart by.
std::vector<double> LeftEdges(const std::vector<Box>& boxes) {
  std::vector<double> left_edges;
  for (const Box& box : boxes) left_edges.push_back(box.x_min);
  return left_edges;
}

std::vector<double> NearerThan(const Sequence& sequence, size_t detection_index) {
  return LeftEdges(NearerBoxes(sequence, sequence.detections.at(detection_index)));
}

TEST(NearerBoxesTest, TheLowerFootOnACommonFloorIsNearer) {
  const Sequence sequence =
      LevelSequence({{10, 100, 20, 300}, {11, 100, 20, 340}, {12, 100, 20, 320}});
  EXPECT_THAT(NearerThan(sequence, 0), ElementsAre(11, 12));
  EXPECT_THAT(NearerThan(sequence, 1), IsEmpty());
  EXPECT_THAT(NearerThan(sequence, 2), ElementsAre(11));
}

TEST(NearerBoxesTest, EqualDepthsHideNeither) {
  const Sequence sequence = LevelSequence({{10, 100, 20, 300}, {11, 50, 90, 300}});
  EXPECT_THAT(NearerThan(sequence, 0), IsEmpty());
  EXPECT_THAT(NearerThan(sequence, 1), IsEmpty());
}

TEST(NearerBoxesTest, EachFootIsOnItsOwnPlane) {
  Sequence sequence = LevelSequence({{10, 100, 20, 300}, {11, 100, 20, 290}});
  EXPECT_THAT(NearerThan(sequence, 0), IsEmpty());      // 8.3 m and 10 m
  sequence.detections[1].plane_in_camera.offset = 0.3;  // on a table: 3 m
  EXPECT_THAT(NearerThan(sequence, 0), ElementsAre(11));
  EXPECT_THAT(NearerThan(sequence, 1), IsEmpty());
}

// The floor falls towards the right: of two boxes with the same lower edge, the right one's foot is
// farther. Their left edges would say the opposite.
TEST(NearerBoxesTest, TheFootIsInTheMiddleOfTheLowerEdge) {
  Sequence sequence = LevelSequence({{320, 100, 340, 300}, {310, 100, 480, 300}});
  for (Detection& detection : sequence.detections) {
    detection.plane_in_camera.normal = Eigen::Vector3d(0.1, -1.0, 0.0).normalized();
  }
  EXPECT_THAT(NearerThan(sequence, 0), IsEmpty());
  EXPECT_THAT(NearerThan(sequence, 1), ElementsAre(320));
}

// On the horizon, above it, and with the camera in the plane.
TEST(NearerBoxesTest, AFootThatDoesNotMeetItsPlaneInFrontIsInfinitelyFar) {
  Sequence sequence = LevelSequence(
      {{10, 100, 20, 300}, {11, 100, 20, 240}, {12, 100, 20, 200}, {13, 100, 20, 470}});
  sequence.detections[3].plane_in_camera.offset = 0.0;
  EXPECT_THAT(NearerThan(sequence, 0), IsEmpty());
  for (const size_t far : {1, 2, 3}) EXPECT_THAT(NearerThan(sequence, far), ElementsAre(10)) << far;
}

TEST(NearerBoxesTest, OnlyTheSameFrameCounts) {
  Sequence sequence = LevelSequence({{10, 100, 20, 300}, {11, 100, 20, 340}, {12, 100, 20, 350}});
  sequence.frames.resize(3);
  for (size_t i = 0; i < 3; ++i) sequence.detections[i].frame_index = static_cast<int>(i);
  EXPECT_THAT(NearerThan(sequence, 0), IsEmpty());
  sequence.detections[1].frame_index = 0;
  EXPECT_THAT(NearerThan(sequence, 0), ElementsAre(11));
}

// As when a box is moved to ask what would hide it there.
TEST(NearerBoxesTest, TheDetectionNeedNotBeTheSequencesOwn) {
  const Sequence sequence = LevelSequence({{10, 100, 20, 300}, {11, 100, 20, 340}});
  Detection moved = sequence.detections[0];
  moved.box.y_max = 200.0;
  EXPECT_THAT(LeftEdges(NearerBoxes(sequence, moved)), ElementsAre(11));
}

}  // namespace
}  // namespace soslam
