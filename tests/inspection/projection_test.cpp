// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/random.h"

namespace soslam {
namespace {

// Shoelace formula.
double Area(const Polygon& polygon) {
  double twice = 0.0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& next = polygon[(i + 1) % polygon.size()];
    twice += polygon[i].x() * next.y() - next.x() * polygon[i].y();
  }
  return std::abs(twice) / 2.0;
}

// A sphere straight ahead is a disc of radius f tan(asin(r / d)). The polygon is half a pixel off
// at most, over a rim of 540 px.
TEST(OutlinePolygon, OfASphereIsADisc) {
  Camera camera = TestCamera();
  camera.fy = camera.fx;
  const Landmark sphere{{Eigen::Quaterniond::Identity(), {0.0, 0.0, 4.0}},
                        Eigen::Vector3d::Constant(0.6)};
  const double radius = camera.fx * std::tan(std::asin(0.6 / 4.0));
  const Polygon outline = OutlinePolygon(camera, sphere);
  EXPECT_NEAR(Area(outline), std::numbers::pi * radius * radius,
              2.0 * std::numbers::pi * radius * 0.5);
  for (const Eigen::Vector2d& pixel : outline) {
    EXPECT_NEAR((pixel - Eigen::Vector2d(camera.cx, camera.cy)).norm(), radius, 1e-3);
  }
}

TEST(OutlinePolygon, OfACuboidInFrontIsItsNearFace) {
  const Camera camera = TestCamera();
  const Landmark cuboid{
      {Eigen::Quaterniond::Identity(), {0.0, 0.0, 5.0}}, {0.5, 0.4, 1.0}, kCuboidExponent};
  const Polygon outline = OutlinePolygon(camera, cuboid);
  ASSERT_EQ(outline.size(), 4u);
  EXPECT_NEAR(Area(outline), (2.0 * 0.5 * camera.fx / 4.0) * (2.0 * 0.4 * camera.fy / 4.0), 1.0);
}

TEST(ProjectSegment, EndsWhereTheCameraIs) {
  const Camera camera = TestCamera();
  const LineSegment3 through{Eigen::Vector3d(0.3, 0.2, -1.0), Eigen::Vector3d(0.3, 0.2, 3.0)};
  const auto visible = ProjectSegment(camera, through);
  ASSERT_TRUE(visible);
  EXPECT_EQ((*visible)[1], *camera.Project(through[1]));
  // On the same line of the image, beyond its far end.
  const Eigen::Vector2d centre(camera.cx, camera.cy);
  const Eigen::Vector2d near = (*visible)[0] - centre;
  const Eigen::Vector2d far = (*visible)[1] - centre;
  EXPECT_NEAR(near.x() * far.y() - near.y() * far.x(), 0.0, 1e-6 * near.norm() * far.norm());
  EXPECT_GT(near.norm(), far.norm());
  EXPECT_FALSE(ProjectSegment(camera, {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, -2)}));
}

TEST(GridAround, IsOnThePlaneAroundThePoints) {
  for (const double extent : {0.2, 3.0, 60.0}) {
    const Plane plane = RandomPlane();
    const Rigid3d frame_from_plane = {UprightRotation(plane.normal, 0.0),
                                      -plane.offset * plane.normal};
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 5; ++i) {
      points.push_back(frame_from_plane * RandomVector(-extent, extent));
    }
    const auto lines = GridAround(plane, points).lines;
    EXPECT_LE(lines.size(), static_cast<size_t>(2 * (kMaxGridLines + 2)));
    Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
    for (const LineSegment3& line : lines) {
      for (const Eigen::Vector3d& end : line) {
        EXPECT_NEAR(plane.SignedDistance(end), 0.0, 1e-9);
        const Eigen::Array2d place = (frame_from_plane.Inverse() * end).head<2>().array();
        low = low.min(place);
        high = high.max(place);
      }
    }
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Array2d place = (frame_from_plane.Inverse() * point).head<2>().array();
      EXPECT_TRUE((place >= low).all() && (place <= high).all());
    }
  }
}

}  // namespace
}  // namespace soslam
