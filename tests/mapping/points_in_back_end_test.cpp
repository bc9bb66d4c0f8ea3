// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/evaluation/metrics.h"
#include "soslam/initialisation/points_in_frames.h"
#include "support/cuboid_map.h"
#include "support/points_on_objects.h"

namespace soslam {
namespace {

// How much points improve the mean intersection over union, where little is known of the ratios.
// `noisy` is the sequence with errors of its boxes.
double GainOfPoints(const Sequence& sequence, const Sequence& noisy,
                    const OptimiseOptions& options) {
  BackEndInput input = TruthInput(noisy, 0.3);
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
  const Sequence sequence = CuboidSequence(3, 8);
  EXPECT_GT(GainOfPoints(sequence, WithBoxNoise(sequence, 6.0), options), 0.02);
}

// With the options as they are shipped, points that are exact do not harm boxes with errors.
TEST(TangencyBackEnd, PointsWithDefaultWeightsDoNoHarm) {
  const Sequence sequence = CuboidSequence(3, 8);
  EXPECT_GT(GainOfPoints(sequence, WithBoxNoise(sequence, 6.0), TangencyOptions()), -0.01);
}

}  // namespace
}  // namespace soslam
