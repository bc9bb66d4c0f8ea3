// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dataset/gate.h"
#include "model/occlusion.h"
#include "support/level_sequence.h"

namespace soslam {
namespace {

using Bounds = std::array<bool, 4>;  // left, top, right, bottom
constexpr Bounds kNone = {false, false, false, false};
constexpr Bounds kBottom = {false, false, false, true};

// Bound edges of each box, given the others in the same frame.
std::vector<Bounds> BoundsOfAll(Sequence sequence, double hidden_edge_fraction = 0.7) {
  ListBoxesInView(sequence, &sequence);
  for (Detection& detection : sequence.detections) {
    detection.is_bound = EdgesCutByBorder(detection.box, sequence.CameraOf(detection));
  }
  ImportOptions options;
  options.hidden_edge_fraction = hidden_edge_fraction;
  MarkHiddenEdges(options, &sequence);
  std::vector<Bounds> bounds;
  for (const Detection& detection : sequence.detections) bounds.push_back(detection.is_bound);
  return bounds;
}

Bounds BoundsOfFirst(const std::vector<Box>& boxes, double hidden_edge_fraction = 0.7) {
  return BoundsOfAll(LevelSequence(boxes), hidden_edge_fraction).front();
}

const Box kBox = {200, 150, 300, 300};

TEST(BoundEdgesTest, ABoxAloneInsideTheImageHasNone) { EXPECT_EQ(BoundsOfFirst({kBox}), kNone); }

// The image covers [-0.5, 639.5] x [-0.5, 479.5].
TEST(BoundEdgesTest, EdgesAtTheImageBorderAreBounds) {
  EXPECT_EQ(BoundsOfFirst({{4.29, 150, 300, 300}}), (Bounds{true, false, false, false}));
  EXPECT_EQ(BoundsOfFirst({{200, 4.29, 300, 300}}), (Bounds{false, true, false, false}));
  EXPECT_EQ(BoundsOfFirst({{200, 150, 634.71, 300}}), (Bounds{false, false, true, false}));
  EXPECT_EQ(BoundsOfFirst({{200, 150, 300, 474.71}}), kBottom);
  EXPECT_EQ(BoundsOfFirst({{-20, 0, 700, 480}}), (Bounds{true, true, true, true}));
  EXPECT_EQ(BoundsOfFirst({{4.31, 4.31, 100, 100}}), kNone);
  EXPECT_EQ(BoundsOfFirst({{535, 375, 634.69, 474.69}}), kNone);
  // Large boxes err more: 2 % of their width, here 12 px.
  EXPECT_EQ(BoundsOfFirst({{11.4, 150, 620, 300}}), (Bounds{true, false, false, false}));
}

TEST(BoundEdgesTest, ALowerEdgeHiddenByExactlyTheFractionIsABound) {
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 200, 270, 400}}), kBottom);
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 200, 269.99, 400}}), kNone);
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 200, 269.99, 400}}, 0.699), kBottom);
  EXPECT_EQ(BoundsOfFirst({{0.1 + 99.9, 150, 100.3, 300}, {50, 200, 100.21, 400}}), kBottom);
}

TEST(BoundEdgesTest, TheLimitsOfTheFraction) {
  EXPECT_EQ(BoundsOfFirst({kBox, {200, 200, 300, 400}}, 1.0), kBottom);
  EXPECT_EQ(BoundsOfFirst({kBox, {200, 200, 299.9, 400}}, 1.0), kNone);
  EXPECT_EQ(BoundsOfFirst({kBox}, 0.0), kBottom);
}

TEST(BoundEdgesTest, SeveralBoxesHideTogetherAndOverlapsCountOnce) {
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 200, 240, 400}, {270, 200, 350, 400}}), kBottom);  // 40 + 30
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 200, 240, 400}, {220, 200, 269, 400}}), kNone);    // 69
  EXPECT_EQ(BoundsOfFirst({kBox, {220, 200, 270, 400}, {180, 200, 240, 400}}), kBottom);  // 70
  EXPECT_EQ(BoundsOfFirst({kBox, {210, 200, 275, 400}, {230, 200, 240, 410}}), kNone);    // 65
}

TEST(BoundEdgesTest, ANearerBoxHidesOnlyWhatIsInsideIt) {
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 300, 320, 400}}), kBottom);    // begins at the edge
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 307.5, 320, 400}}), kBottom);  // up to 5 % of the height
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 307.6, 320, 400}}), kNone);    // below
  EXPECT_EQ(BoundsOfFirst({kBox, {300, 200, 400, 400}}), kNone);      // beside
}

TEST(BoundEdgesTest, ObjectsThatAreNotNearerHideNothing) {
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 100, 320, 300}}), kNone);  // as far
  // Farther, though its box ends lower: it stands lower by 3 m.
  Sequence sequence = LevelSequence({kBox, {180, 100, 320, 400}});
  sequence.detections[1].plane_in_camera.offset = 4.0;
  EXPECT_EQ(BoundsOfAll(sequence)[0], kNone);
}

TEST(BoundEdgesTest, SidesAndTopInsideNearerBoxesStayMeasured) {
  EXPECT_EQ(BoundsOfFirst({kBox, {280, 100, 400, 400}}), kNone);    // all of the right side
  EXPECT_EQ(BoundsOfFirst({kBox, {150, 100, 400, 400}}), kBottom);  // the whole box
}

TEST(BoundEdgesTest, TheNearerObjectsOwnEdgesStayMeasured) {
  EXPECT_EQ(BoundsOfAll(LevelSequence({kBox, {180, 200, 320, 400}}))[1], kNone);
}

TEST(BoundEdgesTest, WhatWasMarkedBeforeIsDecidedAgain) {
  Sequence sequence = LevelSequence({kBox});
  sequence.detections[0].is_bound = {true, true, true, true};
  EXPECT_EQ(BoundsOfAll(sequence)[0], kNone);
}

}  // namespace
}  // namespace soslam
