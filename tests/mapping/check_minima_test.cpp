// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/check_minima.h"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "soslam/mapping/back_end_problem.h"
#include "support/cuboid_map.h"

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

// The edges of turned bodies are not in the images. This costs as much as edges weigh at the bodies
// that they are of; by their own weight, next to nothing.
TEST(CheckMinima, EdgesThatAreNotSeenCostAsMuchAsTheyWeigh) {
  const Sequence sequence = CuboidSequence(3, 4);
  BackEndInput input = TruthInput(sequence);
  input.images = DrawnEdges(sequence);
  const OptimiseOptions options = Options();
  const auto constant_cost = [&] {
    BackEndProblem problem(input, options);
    problem.RenewImageResiduals();
    return problem.summary().constant_cost;
  };
  const double of_truth = constant_cost();
  const auto truth = input.initial_landmarks;
  for (auto& landmark : input.initial_landmarks) landmark = RotatedAboutZ(*landmark, 0.5);
  const double by_own_weight = constant_cost();
  input.images_weighed_at = truth;
  const double by_weight_of_truth = constant_cost();
  EXPECT_GT(by_weight_of_truth, 3.0 * of_truth);
  EXPECT_GT(by_weight_of_truth, 3.0 * by_own_weight);
}

// A body half a turn on is the same one, and no other minimum.
TEST(CheckMinima, BodiesThatAreTheSameAreOneMinimum) {
  const Sequence sequence = CuboidSequence(1, 12);
  BackEndInput input = TruthInput(sequence);
  const Landmark truth = *input.initial_landmarks[0];
  input.initial_landmarks[0] = RotatedAboutZ(truth, std::numbers::pi);
  const auto minima = CheckMinima(input, Options(), 1);
  ASSERT_EQ(minima.size(), 1u);
  EXPECT_EQ(minima[0].cost, minima[0].lowest_cost);
}

}  // namespace
}  // namespace soslam
