// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "evaluation/metrics.h"
#include "initialisation/object_points.h"
#include "support/cuboid_map.h"
#include "support/points_on_objects.h"
#include "support/random.h"

namespace soslam {
namespace {

// How much points improve the mean intersection over union, where boxes have errors and little is
// known of the ratios.
double GainOfPoints(const OptimiseOptions& options) {
  const Sequence sequence = CuboidSequence(3, 8);
  const Sequence noisy = WithBoxNoise(sequence, 6.0);
  BackEndInput input = TruthInput(noisy);
  for (auto& prior : input.priors) prior->log_sigma = {0.3, 0.3};
  const auto mean_iou = [&] {
    return EvaluateMap(sequence, OptimiseMap(input, options)).summary.iou_mean.value();
  };
  const double boxes = mean_iou();
  input.points = FindObjectPoints(noisy, PointsOnObjects(sequence, 100), options.points);
  return mean_iou() - boxes;
}

TEST(TangencyBackEnd, PointsImproveWhatBoxesSay) {
  OptimiseOptions options = TangencyOptions();
  options.points.effective_points = 100.0;
  options.points.point_range_fraction = 0.0;
  EXPECT_GT(GainOfPoints(options), 0.02);
}

// With the options as they are shipped, points that are exact do not harm boxes with errors.
TEST(TangencyBackEnd, PointsWithDefaultWeightsDoNoHarm) {
  EXPECT_GT(GainOfPoints(TangencyOptions()), -0.01);
}

TEST(TangencyBackEnd, ObjectsWithoutPointsAreCounted) {
  const Sequence sequence = CuboidSequence(3, 8);
  BackEndInput input = TruthInput(sequence);
  input.points.resize(sequence.objects.size());
  EXPECT_EQ(OptimiseMap(input, TangencyOptions()).solver.gated.at("objects_without_points"), 3);
}

}  // namespace
}  // namespace soslam
