// SPDX-License-Identifier: BSD-3-Clause
#include "association/up_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geometry/angles.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

double RandomNormal() { return std::normal_distribution<double>()(TestRandom()); }

// The rotation of a camera that looks along the world's x axis, with z up.
Eigen::Quaterniond LevelCamera() {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Eigen::Quaterniond(axes);
}

Sequence SequenceOf(const std::vector<Eigen::Quaterniond>& rotations) {
  Sequence sequence;
  for (const Eigen::Quaterniond& rotation : rotations) {
    Frame frame;
    frame.id = static_cast<int>(sequence.frames.size());
    frame.world_from_camera = {rotation, Eigen::Vector3d::Zero()};
    sequence.frames.push_back(frame);
  }
  return sequence;
}

// The horizon of one camera leans as it is rolled, about its x axis it may be pitched.
TEST(UpEstimateTest, OneCameraIsAsUncertainAsItIsHeld) {
  AssociateOptions options;
  options.camera_roll_sigma_deg = 4.0;
  options.camera_pitch_sigma_deg = 20.0;
  const UpEstimate up = UpOfSegments(SequenceOf({LevelCamera()}), SemanticTable(), options).at(0);
  EXPECT_NEAR((up.up_in_world - Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-12);
  const Eigen::Vector3d variances = Eigen::Vector3d(4.0, 20.0, 0.0).array().square();
  const Eigen::Matrix3d expected = (kRadPerDeg * kRadPerDeg * variances).asDiagonal();
  EXPECT_LT((up.covariance - expected).norm(), 1e-9);
}

TEST(UpEstimateTest, EachSegmentHasItsOwn) {
  const Eigen::Quaterniond turn = RandomRotation();
  Sequence sequence = SequenceOf({LevelCamera(), turn * LevelCamera()});
  sequence.frames[1].segment = 1;
  const auto up = UpOfSegments(sequence, SemanticTable(), AssociateOptions());
  ASSERT_EQ(up.size(), 2u);
  EXPECT_LT((up.at(1).up_in_world - turn * up.at(0).up_in_world).norm(), 1e-9);
}

// Cameras all around that look down by half a right angle and are rolled by the given sigma.
TEST(UpEstimateTest, ErrorsAreAsLargeAsTheCovarianceSays) {
  constexpr int kTrials = 200;
  const AssociateOptions options;
  double sum = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Eigen::Quaterniond> rotations;
    for (int i = 0; i < 6; ++i) {
      const Eigen::AngleAxisd heading(i * std::numbers::pi / 3.0, Eigen::Vector3d::UnitZ());
      const Eigen::AngleAxisd pitch(-45.0 * kRadPerDeg, Eigen::Vector3d::UnitX());
      const Eigen::AngleAxisd roll(options.camera_roll_sigma_deg * kRadPerDeg * RandomNormal(),
                                   Eigen::Vector3d::UnitZ());
      rotations.push_back(heading * LevelCamera() * pitch * roll);
    }
    const UpEstimate up = UpOfSegments(SequenceOf(rotations), SemanticTable(), options).at(0);
    const Eigen::Vector3d error = up.up_in_world.cross(Eigen::Vector3d::UnitZ());
    const Eigen::Matrix3d about_up = up.up_in_world * up.up_in_world.transpose();
    sum += error.dot((up.covariance + about_up).inverse() * error);
  }
  // Chi-square with two degrees of freedom: the mean of 200 has a standard deviation of 0.14.
  // Attitudes that are exact in pitch add information that is not used.
  EXPECT_GT(sum / kTrials, 0.5);
  EXPECT_LT(sum / kTrials, 2.5);
}

// Which end is up does not matter.
TEST(UpEstimateTest, SingleBoxesSayHowCamerasAreRolled) {
  for (int quarters = 0; quarters < 4; ++quarters) {
    const UpEstimate up =
        UpOfSegments(Rolled(PostsAndMats(), quarters), TableOfPostsAndMats(), AssociateOptions())
            .at(0);
    EXPECT_GT(std::abs(up.up_in_world.z()), std::cos(25.0 * kRadPerDeg)) << quarters;
    EXPECT_LT(up.covariance.norm(), 0.3) << quarters;
  }
}

// Spreads as of labels that stand for many things.
TEST(UpEstimateTest, OtherWaysToHoldCamerasAreNamedWithTheirProbabilities) {
  const auto up_with = [](double log_sigma) {
    return UpOfSegments(Rolled(PostsAndMats(), 1), TableOfPostsAndMats(log_sigma),
                        AssociateOptions())
        .at(0);
  };
  const UpEstimate clear = up_with(0.3);
  EXPECT_EQ(clear.holding, CameraHolding::kRolled90);
  EXPECT_EQ(clear.holding_tilt_variance, 0.0);
  const UpEstimate open = up_with(0.5);
  EXPECT_EQ(open.holding, CameraHolding::kRolled90);
  EXPECT_GT(open.holding_tilt_variance, 0.0);
  double sum = 0.0;
  for (const TriedHolding& tried : open.holdings) sum += tried.probability;
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

// A table that says nothing leaves cameras level, and no surer of it.
TEST(UpEstimateTest, BoxesThatSayNothingMakeNothingSurer) {
  const Sequence sequence = PostsAndMats();
  Sequence without = sequence;
  without.detections.clear();
  const auto with_boxes = UpOfSegments(sequence, SemanticTable(), AssociateOptions()).at(0);
  const auto alone = UpOfSegments(without, SemanticTable(), AssociateOptions()).at(0);
  EXPECT_EQ(with_boxes.up_in_world, alone.up_in_world);
  const Eigen::Matrix3d added = with_boxes.covariance - alone.covariance;
  EXPECT_GE(added.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-12);
}

}  // namespace
}  // namespace soslam
