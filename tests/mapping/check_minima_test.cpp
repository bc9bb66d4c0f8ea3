// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/check_minima.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "support/cuboid_map.h"
#include "support/one_body.h"

namespace soslam {
namespace {

OptimiseOptions Options() {
  OptimiseOptions options;
  options.detection_model = DetectionModel::kTangency;
  options.upright.axes_weight = 0.0;
  return options;
}

TEST(CheckMinima, TrueLandmarksOfExactBoxesAreLowest) {
  const Sequence sequence = CuboidSequence(3, 12);
  const auto minima = CheckMinima(TruthInput(sequence), Options(), 2);
  ASSERT_EQ(minima.size(), 3u);
  for (const ObjectMinimum& minimum : minima) {
    EXPECT_LT(minimum.cost, 1e-3);
    EXPECT_FALSE(minimum.IsAboveLowest());
  }
}

// A cuboid called by its other horizontal axis is a minimum of its own, against the prior's ratio.
TEST(CheckMinima, FindsTheMinimumAQuarterTurnAway) {
  const Sequence sequence = CuboidSequence(3, 12);
  BackEndInput input = TruthInput(sequence);
  Landmark& wrong = *input.initial_landmarks[1];
  const Landmark truth = wrong;
  wrong = RotatedAboutZ(wrong, 0.5 * std::numbers::pi);
  std::swap(wrong.half_axes.x(), wrong.half_axes.y());
  input.priors[1]->log_sigma = {0.1, 0.1};
  const auto minima = CheckMinima(input, Options(), 1);
  ASSERT_EQ(minima.size(), 3u);
  EXPECT_FALSE(minima[0].IsAboveLowest());
  EXPECT_TRUE(minima[1].IsAboveLowest()) << minima[1].cost << " " << minima[1].lowest_cost;
  EXPECT_LT((minima[1].lowest_in_world.half_axes - truth.half_axes).norm(), 1e-2);
  EXPECT_FALSE(minima[2].IsAboveLowest());
}

// Exact boxes from all sides leave it to the ratio alone which horizontal axis is x: with a / b =
// r, the cost of both residuals is log(r)^2 over the variance.
TEST(QuarterTurnProbabilities, AreThoseOfTheRatio) {
  Landmark body;
  body.shape_exponents = kCuboidExponent;
  body.half_axes = {0.3, 0.4, 0.35};
  body.frame_from_object.translation.z() = 0.35;
  const Sequence sequence = ViewsOfBody(body, CamerasOnArc(100, 6.0));
  BackEndInput input = TruthInput(sequence);
  input.priors[0]->log_sigma.setConstant(std::log(4.0 / 3.0));
  OptimiseOptions options = Options();
  options.upright.detection_sigma_fraction = 1e-3;
  options.upright.view_correlation_deg = 0.0;
  for (const double dispersion : {1.0, 2.0}) {
    EXPECT_NEAR(QuarterTurnProbabilities(input, options, dispersion, 1)[0].value(),
                1.0 / (1.0 + std::exp(1.0 / dispersion)), 0.01);
  }
}

TEST(QuarterTurnProbabilities, AreNoneWithoutLandmarks) {
  const Sequence sequence = CuboidSequence(2, 12);
  BackEndInput input = TruthInput(sequence);
  input.initial_landmarks[0].reset();
  const auto probabilities = QuarterTurnProbabilities(input, Options(), 1.0, 1);
  EXPECT_FALSE(probabilities[0]);
  EXPECT_TRUE(probabilities[1]);
}

}  // namespace
}  // namespace soslam
