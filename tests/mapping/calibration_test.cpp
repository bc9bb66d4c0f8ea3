// SPDX-License-Identifier: BSD-3-Clause
// Covariances of the back end for what boxes, odometry, ratios and planes say.
#include "support/calibration.h"

#include <gtest/gtest.h>

#include "evaluation/result_checks.h"

namespace soslam::calibration {
namespace {

TEST(Calibration, CovariancesAreHonestWhereTheModelHolds) {
  for (const double p : {1.0, 1.3, 2.0}) {
    SCOPED_TRACE(p);
    Case c;
    c.shape_exponent = c.assumed_exponent = p;
    ExpectHonest(MeanNees(c), c.scenes);
  }
}

// An object whose boxes all are too large, or too far to one side.
TEST(Calibration, CovariancesAreHonestWhereBoxesShareAMisfit) {
  Case c;
  c.actual.misfit_sigma_fraction = c.assumed.misfit_sigma_fraction =
      OptimiseOptions().misfit_sigma_fraction;
  ExpectHonest(MeanNees(c), c.scenes);
  c.assumed.misfit_sigma_fraction = 0.0;
  EXPECT_GT(MeanNees(c).centre, 1.5);
}

// A loss that forgives outliers costs next to nothing where there are none.
TEST(Calibration, HoldsUnderTheHuberLoss) {
  Case c;
  c.assumed.huber_delta = OptimiseOptions().huber_delta;
  ExpectHonest(MeanNees(c), c.scenes);
}

// In how many of 50 scenes the poses are farther from the odometry than its noise allows.
int ScenesWithFarPoses(const OptimiseOptions& actual, const OptimiseOptions& assumed) {
  int far = 0;
  for (int i = 0; i < 50; ++i) {
    const Truth truth = RandomTruth({}, actual);
    const Sequence sequence = Observe(truth, actual);
    const BackEndInput input{sequence, {truth.landmark_in_world}, {truth.prior}, {}, {}};
    const MapEstimate map = OptimiseMap(input, assumed);
    far += static_cast<int>(
        CheckPoseCorrections(sequence, map.world_from_camera, assumed.Odometry()).size());
  }
  return far;
}

TEST(PoseCorrections, AreFarOnlyWhereOdometryIsWorseThanItsNoise) {
  const OptimiseOptions model = ModelOptions();
  EXPECT_EQ(ScenesWithFarPoses(model, model), 0);
  OptimiseOptions worse = model;
  worse.odometry_rotation_sigma_deg *= 30.0;
  worse.odometry_translation_sigma_m *= 30.0;
  OptimiseOptions robust = model;
  robust.huber_delta = OptimiseOptions().huber_delta;
  EXPECT_GE(ScenesWithFarPoses(worse, model), 45);
  EXPECT_GE(ScenesWithFarPoses(worse, robust), 45);
}

// The cases of the table in docs/shapes.md where it does not hold.
TEST(Calibration, IsCautiousWhereErrorsAreIndependentButTakenForShared) {
  Case c;
  c.assumed.view_correlation_deg = OptimiseOptions().view_correlation_deg;
  const Nees nees = MeanNees(c);
  for (const double mean : {nees.centre, nees.size, nees.yaw}) {
    EXPECT_GT(mean, 0.4);
    EXPECT_LT(mean, 0.8);
  }
}

TEST(Calibration, IsOverconfidentForAWrongShapeButLessWithSharedErrors) {
  Case c;
  c.shape_exponent = 1.3;  // and taken for a cuboid
  const Nees independent = MeanNees(c);
  c.assumed.view_correlation_deg = OptimiseOptions().view_correlation_deg;
  const Nees shared = MeanNees(c);
  EXPECT_GT(independent.size, 50.0);
  EXPECT_GT(independent.centre, 10.0);
  EXPECT_LT(shared.size, 0.6 * independent.size);
  EXPECT_LT(shared.centre, 0.6 * independent.centre);
}

TEST(Calibration, IsOverconfidentOfTheYawOfARoundBody) {
  Case c;
  c.shape_exponent = c.assumed_exponent = kEllipsoidExponent;
  c.ratio_range = {0.9, 1.1, 0.9, 1.1};
  const Nees nees = MeanNees(c);
  ExpectWithin99Percent(nees.centre, 3 * c.scenes, "centre");
  ExpectWithin99Percent(nees.size, 3 * c.scenes, "size");
  c.scenes = 2000;  // so that the bound lies well below the mean, whichever scenes a compiler draws
  EXPECT_GT(MeanNees(c).yaw, ChiSquareQuantile(c.scenes, 2.5758));
}

}  // namespace
}  // namespace soslam::calibration
