// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/box_likelihood.h"

#include <gtest/gtest.h>

#include "support/association_scenes.h"

namespace soslam {
namespace {

// A cuboid known from its first frames, and where it is expected in a later one.
class BoxLikelihoodTest : public testing::Test {
 protected:
  BoxLikelihoodTest() {
    options_.cut_edge_probability = 0.0;
    detections_ = DetectionsByObject(sequence_)[0];
    const std::vector<int> first(detections_.begin(), detections_.begin() + 3);
    object_ = *FitTrack(sequence_, first, *UnknowingTable().default_prior, options_,
                        sequence_.planes[0].plane_in_world);
    expected_ = sequence_.detections[detections_[3]];
    expected_.box = Predicted(0).outline;
  }

  Prediction Predicted(int frames_ago) const {
    const BoxLikelihood likelihood(sequence_, options_);
    return *likelihood.Predict(object_, expected_.frame_index - frames_ago, expected_.frame_index);
  }
  std::optional<BoxMatch> Match(const Box& box, int frames_ago = 0) const {
    Detection detection = expected_;
    detection.box = box;
    return BoxLikelihood(sequence_, options_).Match(Predicted(frames_ago), detection);
  }
  // The expected box, moved to the right by a share of its width.
  Box Shifted(double share) const {
    Box box = expected_.box;
    box.x_min += share * expected_.box.Width();
    box.x_max += share * expected_.box.Width();
    return box;
  }

  // The expected box with its right edge moved out by a share of its width.
  Box Wider(double share) const {
    Box box = expected_.box;
    box.x_max += share * box.Width();
    return box;
  }

  AssociateOptions options_ = EstimatedAssociation();
  Sequence sequence_ = SyntheticSequence(LabelledScene(3, 1, 30, {"box"}), false);
  std::vector<int> detections_;
  FittedObject object_;
  Detection expected_;
};

TEST_F(BoxLikelihoodTest, TheExpectedBoxIsExplainedBest) {
  const auto best = Match(expected_.box);
  ASSERT_TRUE(best);
  EXPECT_NEAR(best->distance, 0.0, 1e-4);  // outlines are exact to a fraction of a pixel
  EXPECT_EQ(best->overlap, 1.0);
  double before = best->cost;
  for (const double share : {0.05, 0.1, 0.2}) {
    const auto shifted = Match(Shifted(share));
    ASSERT_TRUE(shifted) << share;
    EXPECT_GT(shifted->cost, before) << share;
    before = shifted->cost;
  }
  EXPECT_LT(best->cost, BoxLikelihood(sequence_, options_).CostOfAnyBox(expected_));
}

TEST_F(BoxLikelihoodTest, ABoxThatIsWrongByTheBiasIsTheExpectedOne) {
  Detection detection = expected_;
  detection.box.y_max -= 0.2 * expected_.box.Height();
  const auto match = [&](const EdgeBias& bias) {
    const BoxLikelihood likelihood(sequence_, options_);
    const int frame = expected_.frame_index;
    return likelihood.Match(*likelihood.Predict(object_, frame, frame, bias), detection);
  };
  const auto corrected = match({0.0, 0.0, 0.0, -0.25});  // of the height that is left
  ASSERT_TRUE(corrected);
  EXPECT_NEAR(corrected->distance, 0.0, 1e-4);
  EXPECT_NEAR(corrected->overlap, 1.0, 1e-12);
  const auto taken_as_it_is = match({});
  EXPECT_TRUE(!taken_as_it_is || taken_as_it_is->distance > 1.0);
}

// Near ones are compared, and found less likely.
TEST_F(BoxLikelihoodTest, ABoxFarOffIsNotExplainedAtAll) {
  EXPECT_TRUE(Match(Shifted(0.5)));
  EXPECT_FALSE(Match(Shifted(20.0)));
}

// What the density gains in width it loses in height.
TEST_F(BoxLikelihoodTest, TheLongerUnseenTheWider) {
  const Box far = Shifted(0.4);
  ASSERT_GE(expected_.frame_index, 3);
  const auto now = Match(far, 0);
  const auto later = Match(far, 3);
  options_.odometry_translation_sigma_m = 0.1;
  const auto drifted = Match(far, 3);
  ASSERT_TRUE(now && later && drifted);
  EXPECT_LT(later->distance, now->distance);
  EXPECT_LT(drifted->distance, 0.7 * later->distance);
  EXPECT_GT(Match(expected_.box, 3)->cost, Match(expected_.box, 0)->cost);
}

TEST_F(BoxLikelihoodTest, OneEdgeMayBeCutOff) {
  const auto as_it_is = Match(Wider(-0.5));
  options_.cut_edge_probability = 0.05;
  const auto as_cut = Match(Wider(-0.5));
  ASSERT_TRUE(as_it_is && as_cut);
  EXPECT_EQ(as_cut->cut_edge, BoxSide::kRight);
  EXPECT_LT(as_cut->cost, as_it_is->cost);
  EXPECT_LT(as_cut->distance, 0.5);
  EXPECT_FALSE(Match(expected_.box)->cut_edge);
}

TEST_F(BoxLikelihoodTest, AOneSidedEdgeNeedsOnlyBeReached) {
  expected_.is_one_sided = {false, false, true, false};
  EXPECT_NEAR(Match(Wider(-0.5))->distance, 0.0, 0.1);
  EXPECT_GT(Match(Wider(0.5))->distance, 1.0);
}

TEST_F(BoxLikelihoodTest, NothingIsExpectedBehindTheCamera) {
  sequence_.frames[expected_.frame_index].world_from_camera.rotation *=
      Eigen::Quaterniond(Eigen::AngleAxisd(3.14, Eigen::Vector3d::UnitY()));
  EXPECT_FALSE(BoxLikelihood(sequence_, options_)
                   .Predict(object_, expected_.frame_index, expected_.frame_index));
}

// Boxes with exactly the noise of the options: squared distances average to the four edges.
TEST(BoxLikelihoodCalibrationTest, DistancesAreInStandardDeviations) {
  AssociateOptions options = EstimatedAssociation();
  options.cut_edge_probability = 0.0;
  options.upright.view_correlation_deg = 0.0;  // errors are independent
  double sum = 0.0;
  int count = 0;
  for (int seed = 0; seed < 12; ++seed) {
    Scene scene = RandomScene(seed, 6, 30, {Shape::kBox});
    scene.noise.box_edge_sigma = options.upright.detection_sigma_fraction;
    Sequence sequence = SyntheticSequence(scene, true);
    for (Frame& frame : sequence.frames) frame.world_from_camera = *frame.true_world_from_camera;
    const BoxLikelihood likelihood(sequence, options);
    for (const std::vector<int>& of_object : DetectionsByObject(sequence)) {
      if (of_object.size() < 4) continue;
      const std::vector<int> first(of_object.begin(), of_object.begin() + 3);
      const auto object = FitTrack(sequence, first, {{1.0, 1.0}, {0.7, 0.7}, kCuboidExponent},
                                   options, sequence.planes[0].plane_in_world);
      if (!object) continue;
      const Detection& next = sequence.detections[of_object[3]];
      const auto prediction = likelihood.Predict(*object, next.frame_index, next.frame_index);
      if (!prediction) continue;
      const auto match = likelihood.Match(*prediction, next);
      ASSERT_TRUE(match) << seed;
      sum += match->distance * match->distance;
      ++count;
    }
  }
  ASSERT_GE(count, 40);
  // The mean of 40 chi-squares with 4 degrees of freedom has a standard deviation of 0.45. The rest
  // is what is not linear: yaws have several optima.
  EXPECT_GT(sum / count, 2.0);
  EXPECT_LT(sum / count, 6.0);
}

}  // namespace
}  // namespace soslam
