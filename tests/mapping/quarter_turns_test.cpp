// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/quarter_turns.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/cuboid_map.h"
#include "support/one_body.h"

namespace soslam {
namespace {

OptimiseOptions QuarterTurnOptions() {
  OptimiseOptions options;
  options.detection_model = DetectionModel::kTangency;
  options.upright.axes_weight = 0.0;
  return options;
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
  OptimiseOptions options = QuarterTurnOptions();
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
  const auto probabilities = QuarterTurnProbabilities(input, QuarterTurnOptions(), 1.0, 1);
  EXPECT_FALSE(probabilities[0]);
  EXPECT_TRUE(probabilities[1]);
}

}  // namespace
}  // namespace soslam
