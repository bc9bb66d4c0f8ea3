// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/visible_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "support/random.h"

namespace soslam {
namespace {

// A cuboid in front of the camera, turned about its vertical axis and a little below the camera.
Landmark RandomCuboid() {
  Landmark cuboid;
  cuboid.shape_exponent = kCuboidExponent;
  cuboid.half_axes = RandomVector(0.2, 0.6);
  cuboid.frame_from_object = {
      UprightRotation(-Eigen::Vector3d::UnitY(), RandomUniform(-3, 3)),
      {RandomUniform(-0.5, 0.5), RandomUniform(0.5, 1.0), RandomUniform(3, 5)}};
  return cuboid;
}

std::vector<Eigen::Vector2d> CornersInImage(const Camera& camera, const Landmark& cuboid) {
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d signs(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    corners.push_back(*camera.Project(cuboid.frame_from_object *
                                      Eigen::Vector3d(signs.cwiseProduct(cuboid.half_axes))));
  }
  return corners;
}

// Box of what is visible of a cuboid to the right of x = cut: the convex hull of its corners,
// clipped there.
Box BoxRightOf(double cut, const std::vector<Eigen::Vector2d>& corners) {
  const double infinity = std::numeric_limits<double>::infinity();
  Box box{cut, infinity, -infinity, -infinity};
  const auto include = [&](const Eigen::Vector2d& point) {
    box.x_max = std::max(box.x_max, point.x());
    box.y_min = std::min(box.y_min, point.y());
    box.y_max = std::max(box.y_max, point.y());
  };
  for (const Eigen::Vector2d& one : corners) {
    if (one.x() >= cut) include(one);
    for (const Eigen::Vector2d& other : corners) {
      if (one.x() < cut && other.x() > cut) {
        include(one + (cut - one.x()) / (other.x() - one.x()) * (other - one));
      }
    }
  }
  return box;
}

// The largest distance (px) between the cuboid's outline and an edge.
double LargestDistance(const std::array<BoxEdge, 4>& edges, const Landmark& cuboid) {
  double largest = 0.0;
  for (const BoxEdge& edge : edges) {
    const double residual = Tangency(edge, cuboid, FindTangentDepth(edge, cuboid), 0.0, nullptr);
    largest = std::max(largest, edge.sigma_px * std::abs(residual));
  }
  return largest;
}

TEST(VisibleEdges, AreFittedByTheTruthHoweverMuchOfItIsCutOff) {
  const Camera camera = TestCamera();
  int contradicted = 0;
  for (int i = 0; i < 200; ++i) {
    const Landmark cuboid = RandomCuboid();
    const auto corners = CornersInImage(camera, cuboid);
    const auto [left, right] =
        std::ranges::minmax_element(corners, {}, [](const auto& p) { return p.x(); });
    const double cut = left->x() + RandomUniform(0.1, 0.9) * (right->x() - left->x());
    const auto edges =
        BoxEdges(camera, BoxRightOf(cut, corners), {true, false, false, false}, 0.02);
    EXPECT_LT(LargestDistance(VisibleEdges(edges, cuboid), cuboid), 1.0);  // corners are rounded
    contradicted += LargestDistance(edges, cuboid) > 5.0 ? 1 : 0;
  }
  EXPECT_GT(contradicted, 20);  // of the edges as they are
}

TEST(VisibleEdges, AreAsTheyWereWithoutBounds) {
  const Camera camera = TestCamera();
  for (int i = 0; i < 20; ++i) {
    const Landmark cuboid = RandomCuboid();
    const Box box = *OutlineBox(camera, RandomCuboid());
    for (const BoxEdge& edge : VisibleEdges(BoxEdges(camera, box, {}, 0.02), cuboid)) {
      EXPECT_FALSE(edge.is_bound);
    }
  }
}

}  // namespace
}  // namespace soslam
