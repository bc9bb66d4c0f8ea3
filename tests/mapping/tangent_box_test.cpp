// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/tangent_box.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

const Box kBox = {200, 150, 420, 330};

// A body so near that it reaches behind the camera with its left side.
Landmark NearOnTheLeft(double shape_exponent) {
  Landmark landmark;
  landmark.frame_from_object.rotation =
      Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitY()) * Eigen::Quaterniond::Identity();
  landmark.frame_from_object.translation = {0.0, 0.0, 0.5};
  landmark.half_axes = {3.0, 0.2, 0.1};
  landmark.shape_exponent = shape_exponent;
  return landmark;
}

TEST(TangentBox, KeepsTheEdgesWhoseTangentPointIsInFront) {
  for (const double p : kShapeExponents) {
    const Landmark start = NearOnTheLeft(p);
    const auto edges = BoxEdges(TestCamera(), kBox, {false, true, false, false}, 0.05);
    const TangentBox box(edges, start);
    const TangentBox copy = box;
    int next = 0;
    for (size_t i = 0; i < edges.size(); ++i) {
      const double depth_m = TangentDepth(edges[i], start);
      if (!(depth_m > 0.0)) continue;
      ASSERT_LT(next, copy.num_edges);
      const TangentBox::Edge& edge = copy.edges[static_cast<size_t>(next++)];
      EXPECT_EQ(edge.side, static_cast<int>(i));
      EXPECT_EQ(edge.is_bound, i == 1);
      EXPECT_DOUBLE_EQ(edge.per_px, 1.0 / edges[i].sigma_px);
      const Eigen::Vector3d plane =
          edges[i].plane * start.Centre().z() / (depth_m * edges[i].sigma_px);
      EXPECT_LT((edge.plane - plane).norm(), 1e-12 * plane.norm());
    }
    EXPECT_EQ(next, copy.num_edges);
    EXPECT_GT(copy.num_edges, 0);
    EXPECT_LT(copy.num_edges, 4);
  }
}

}  // namespace
}  // namespace soslam
