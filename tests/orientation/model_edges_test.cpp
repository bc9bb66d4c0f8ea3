// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "soslam/orientation/edge_alignment.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr double kSpacing = 4.0;

// A body that a camera sees in the middle of its image, from that place in the object frame.
Landmark SeenFrom(const Eigen::Vector3d& camera_in_object, const Eigen::Vector3d& half_axes,
                  const ShapeExponents& shape_exponents) {
  const Eigen::Quaterniond rotation = RotationBetween(
      camera_in_object, -Eigen::Vector3d::UnitZ());  // of the object, into the camera frame
  return {{rotation, {0.0, 0.0, camera_in_object.norm()}}, half_axes, shape_exponents};
}

// Signs of the two coordinates that are fixed along an edge, 0 for the one that runs.
std::array<int, 3> EdgeOf(const ModelPoint& point) {
  std::array<int, 3> edge;
  for (int i = 0; i < 3; ++i) {
    const double x = point.in_unit_body[i];
    edge[i] = std::abs(x) > 1.0 - 1e-12 ? (x > 0.0 ? 1 : -1) : 0;
  }
  return edge;
}

TEST(VisibleModelPoints, CuboidsShowTheEdgesOfTheFacesThatTheCameraSees) {
  const Eigen::Vector3d half_axes(0.5, 0.4, 0.3);
  const std::vector<std::pair<Eigen::Vector3d, size_t>> views = {
      {{2.0, 2.0, 2.0}, 9}, {{-2.0, 2.0, 0.1}, 7}, {{0.1, -0.2, 3.0}, 4}};
  for (const auto& [camera_in_object, edge_count] : views) {
    const Landmark landmark = SeenFrom(camera_in_object, half_axes, kCuboidExponent);
    std::set<std::array<int, 3>> edges;
    for (const ModelPoint& point : VisibleModelPoints(TestCamera(), landmark, kSpacing)) {
      edges.insert(EdgeOf(point));
    }
    EXPECT_EQ(edges.size(), edge_count);
    for (const auto& edge : edges) {
      EXPECT_EQ(std::ranges::count(edge, 0), 1);
      bool visible = false;
      for (size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        visible |= edge[i] * camera_in_object[axis] > half_axes[axis];
      }
      EXPECT_TRUE(visible);
    }
  }
}

TEST(VisibleModelPoints, OfAnEllipsoidLieOnItsOutline) {
  const Camera camera = TestCamera();
  for (int i = 0; i < 50; ++i) {
    const Landmark landmark = RandomLandmarkInCamera();
    const auto box = OutlineBox(camera, landmark);
    if (!box) continue;
    const Eigen::Vector3d camera_in_object = landmark.frame_from_object.Inverse().translation;
    const auto points = VisibleModelPoints(camera, landmark, kSpacing);
    ASSERT_FALSE(points.empty());
    Box around{1e9, 1e9, -1e9, -1e9};
    for (const ModelPoint& point : points) {
      const Eigen::Vector3d in_object = landmark.half_axes.cwiseProduct(point.in_unit_body);
      const Eigen::Vector3d normal = point.in_unit_body.cwiseQuotient(landmark.half_axes);
      // The outline is drawn with 90 corners; points lie on the straight lines between them.
      EXPECT_LT(normal.normalized().dot((camera_in_object - in_object).normalized()), 0.05);
      EXPECT_NEAR(point.in_unit_body.norm(), 1.0, 0.05);
      const Eigen::Vector2d pixel = *camera.Project(landmark.frame_from_object * in_object);
      around = {std::min(around.x_min, pixel.x()), std::min(around.y_min, pixel.y()),
                std::max(around.x_max, pixel.x()), std::max(around.y_max, pixel.y())};
    }
    EXPECT_NEAR(around.x_min, box->x_min, 2.0);
    EXPECT_NEAR(around.y_min, box->y_min, 2.0);
    EXPECT_NEAR(around.x_max, box->x_max, 2.0);
    EXPECT_NEAR(around.y_max, box->y_max, 2.0);
  }
}

TEST(VisibleModelPoints, NoneOfABodyThatReachesBehindTheCamera) {
  for (const double shape_exponents : {kCuboidExponent, kEllipsoidExponent}) {
    for (const double depth : {0.4, -3.0}) {  // half axis 0.5: around the camera, and behind it
      const Landmark landmark{{{1, 0, 0, 0}, {1.0, 0.0, depth}}, {0.5, 0.5, 0.5}, shape_exponents};
      EXPECT_TRUE(VisibleModelPoints(TestCamera(), landmark, kSpacing).empty());
    }
  }
}

}  // namespace
}  // namespace soslam
