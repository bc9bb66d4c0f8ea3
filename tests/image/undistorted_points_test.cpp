// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/undistorted_points.h"

#include <gtest/gtest.h>

#include "soslam/image/distort_pixels.h"

namespace soslam {
namespace {

TEST(UndistortedPoints, AreWhereAPinholeCameraSeesThem) {
  Sequence sequence;
  sequence.camera = {640, 480, 500.0, 500.0, 319.5, 239.5};
  sequence.image_distortion = Distortion{.k1 = -0.2};
  const Eigen::Vector2d pixel(500.0, 100.0);
  const Eigen::Vector2d stored =
      DistortPixels(sequence.camera, *sequence.image_distortion, {pixel}).front();
  ASSERT_GT((stored - pixel).norm(), 5.0);
  MapPoint point;
  // The second one is beyond the largest radius that the lens has.
  point.observations = {{0, stored}, {1, {1e4, 1e4}}, {2, stored}};
  const std::vector<MapPoint> points = WithoutDistortion(sequence, {point});
  ASSERT_EQ(points.front().observations.size(), 2u);
  for (const PointObservation& observation : points.front().observations) {
    EXPECT_LT((observation.pixel - pixel).norm(), 1e-3);
  }
  EXPECT_EQ(points.front().observations.back().frame_id, 2);
  sequence.image_distortion.reset();
  EXPECT_EQ(WithoutDistortion(sequence, {point}).front().observations.size(), 3u);
}

}  // namespace
}  // namespace soslam
