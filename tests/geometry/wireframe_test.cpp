// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/wireframe.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace soslam {
namespace {

int VisibleEdges(const Eigen::Vector3d& centre) {
  const Landmark cube = {
      {Eigen::Quaterniond::Identity(), centre}, Eigen::Vector3d::Constant(0.5), kCuboidExponent};
  const auto edges = UnitCuboidEdges();
  return static_cast<int>(std::ranges::count_if(edges, [&](const LineSegment3& edge) {
    return IsVisibleCuboidEdge(edge, CameraInUnitBody(cube));
  }));
}

TEST(IsVisibleCuboidEdge, FollowsTheVisibleFaces) {
  EXPECT_EQ(VisibleEdges({0.0, 0.0, 3.0}), 4);   // one face
  EXPECT_EQ(VisibleEdges({1.0, 0.0, 3.0}), 7);   // two
  EXPECT_EQ(VisibleEdges({1.0, -1.0, 3.0}), 9);  // three
  EXPECT_EQ(VisibleEdges({0.1, 0.1, 0.1}), 0);   // from inside
}

}  // namespace
}  // namespace soslam
