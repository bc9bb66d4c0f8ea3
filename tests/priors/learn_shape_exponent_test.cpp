// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "priors/learn_priors.h"
#include "support/drawn_cuboids.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

// A body seen from frames in the origin, in a world that each frame has its own part of: the camera
// stands still and the body is somewhere else in each.
Sequence ViewsOfABody(double shape_exponent, int views, double disturbance) {
  Sequence sequence;
  sequence.camera = TestCamera();
  GroundTruth truth;
  truth.landmark_in_world.half_axes = {0.5, 0.3, 0.4};
  sequence.objects = {{0, "thing", 0, truth}};
  for (int i = 0; i < views; ++i) {
    Landmark in_camera = RandomUprightBody(RandomFloor(), shape_exponent);
    in_camera.half_axes = truth.landmark_in_world.half_axes;
    const auto box = OutlineBox(TestCamera(), in_camera);
    if (!box) continue;
    Frame frame;
    frame.true_world_from_camera = in_camera.frame_from_object.Inverse();
    sequence.detections.push_back({static_cast<int>(sequence.frames.size()),
                                   0,
                                   1.0,
                                   Disturbed(*box, disturbance),
                                   {},
                                   {},
                                   {}});
    sequence.frames.push_back(frame);
  }
  return sequence;
}

TEST(LearnShapeExponents, OfExactBoxesIsThatOfTheBody) {
  for (const double exponent : {1.0, 1.3, 1.6, 2.0}) {
    const auto learned = LearnShapeExponents(ViewsOfABody(exponent, 20, 0.0), 10);
    ASSERT_EQ(learned.size(), 1u);
    EXPECT_NEAR(learned.at(0), exponent, 0.011);  // the step of the search
  }
}

TEST(LearnShapeExponents, OfDisturbedBoxesIsNear) {
  EXPECT_NEAR(LearnShapeExponents(ViewsOfABody(1.5, 60, 0.02), 10).at(0), 1.5, 0.08);
}

TEST(LearnShapeExponents, NeedGroundTruthAndEnoughViews) {
  Sequence sequence = ViewsOfABody(1.5, 9, 0.0);
  EXPECT_TRUE(LearnShapeExponents(sequence, 10).empty());
  EXPECT_EQ(LearnShapeExponents(sequence, 1).size(), 1u);
  sequence.objects[0].ground_truth.reset();
  EXPECT_TRUE(LearnShapeExponents(sequence, 1).empty());
}

}  // namespace
}  // namespace soslam
