// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/occlusion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "support/level_sequence.h"
#include "support/random.h"

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

// A box may be moved to find out which boxes would occlude it there.
TEST(NearerBoxesTest, TheDetectionNeedNotBeTheSequencesOwn) {
  const Sequence sequence = LevelSequence({{10, 100, 20, 300}, {11, 100, 20, 340}});
  Detection moved = sequence.detections[0];
  moved.box.y_max = 200.0;
  EXPECT_THAT(LeftEdges(NearerBoxes(sequence, moved)), ElementsAre(11));
}

std::vector<std::array<double, 4>> Sorted(const std::vector<Box>& boxes) {
  std::vector<std::array<double, 4>> sorted;
  for (const Box& box : boxes) sorted.push_back({box.x_min, box.y_min, box.x_max, box.y_max});
  std::ranges::sort(sorted);
  return sorted;
}

// Boxes anywhere, many with the same lower edge, some above the horizon.
Sequence RandomBoxes(int count, bool has_planes) {
  std::vector<Box> boxes;
  for (int i = 0; i < count; ++i) {
    const double x = RandomUniform(0, 500), y = RandomUniform(0, 300);
    boxes.push_back(
        {x, y, x + RandomUniform(5, 100), 10.0 * std::ceil(RandomUniform(y, 450) / 10)});
  }
  Sequence sequence = LevelSequence(boxes);
  Frame second = sequence.frames.front();
  second.id = sequence.frames.back().id + 1;
  sequence.frames.push_back(second);
  for (int i = 0; i < count; i += 3) {
    Detection detection = sequence.detections[i];
    detection.frame_index = static_cast<int>(sequence.frames.size()) - 1;
    sequence.detections.push_back(detection);
  }
  if (!has_planes) sequence.planes.clear();
  return sequence;
}

// Used are some detections, one of them with another box than in view.
TEST(BoxesInFrontTest, AreThoseOfTheDefinition) {
  for (const bool has_planes : {true, false}) {
    for (int round = 0; round < 20; ++round) {
      const Sequence in_view = RandomBoxes(40, has_planes);
      Sequence used = in_view;
      std::erase_if(used.detections,
                    [](const Detection& detection) { return detection.object_index % 4 == 1; });
      used.detections[2].box.y_max -= 60.0;
      ListBoxesInView(in_view, &used);
      for (const Detection& detection : used.detections) {
        EXPECT_EQ(Sorted(BoxesInFront(used, detection)), Sorted(NearerBoxes(in_view, detection)));
      }
    }
  }
}

TEST(BoxesInFrontTest, TheNearestIsFirst) {
  Sequence sequence = LevelSequence({{10, 100, 20, 300}, {11, 100, 20, 320}, {12, 100, 20, 340}});
  ListBoxesInView(sequence, &sequence);
  EXPECT_THAT(LeftEdges(BoxesInFront(sequence, sequence.detections[0])), ElementsAre(12, 11));
}

}  // namespace
}  // namespace soslam
