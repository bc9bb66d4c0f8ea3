// SPDX-License-Identifier: BSD-3-Clause
#include "planes/scene_axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/angles.h"
#include "support/random.h"
#include "support/segment_views.h"

namespace soslam {
namespace {

constexpr double kCorrelation = 20.0 * kRadPerDeg;
const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

// Edges along two horizontal directions at right angles and upwards, among others of any direction.
std::vector<SegmentView> Room(double yaw, int others) {
  const Eigen::Vector3d along(std::cos(yaw), std::sin(yaw), 0.0);
  std::vector<SegmentView> views;
  for (int i = 0; i < 12; ++i) {
    std::vector<Eigen::Vector3d> directions;
    for (int k = 0; k < 6; ++k) {
      directions.insert(directions.end(), {along, kZ.cross(along), kZ});
    }
    for (int k = 0; k < others; ++k) directions.push_back(RandomRotation() * along);
    views.push_back(ViewOfEdges(CameraInRoom(0.5 * i), directions));
  }
  return views;
}

double OffAxis(const Eigen::Vector3d& axis, double yaw) {
  return std::abs(std::remainder(std::atan2(axis.y(), axis.x()) - yaw, 0.5 * std::numbers::pi));
}

// Edges are exact: only those of other directions, which fall near the axis by chance, disturb.
TEST(SceneAxis, IsTheDirectionOfMostEdges) {
  for (int i = 0; i < 20; ++i) {
    const double yaw = RandomUniform(-3.0, 3.0);
    const auto exact = SceneAxis(kZ, Room(yaw, 0), kCorrelation);
    ASSERT_TRUE(exact);
    EXPECT_LT(OffAxis(*exact, yaw), 1e-6);
    EXPECT_NEAR(exact->dot(kZ), 0.0, 1e-12);
    const auto among_others = SceneAxis(kZ, Room(yaw, 10), kCorrelation);
    ASSERT_TRUE(among_others);
    EXPECT_LT(OffAxis(*among_others, yaw), 0.5 * kRadPerDeg);
  }
}

TEST(SceneAxis, IsNoneWhereEdgesHaveNoCommonDirection) {
  EXPECT_FALSE(SceneAxis(kZ, {}, kCorrelation));
  for (int i = 0; i < 20; ++i) {
    std::vector<SegmentView> views;
    for (int camera = 0; camera < 12; ++camera) {
      std::vector<Eigen::Vector3d> directions;
      for (int k = 0; k < 20; ++k) directions.emplace_back(RandomRotation() * kZ);
      views.push_back(ViewOfEdges(CameraInRoom(0.5 * camera), directions));
    }
    EXPECT_FALSE(SceneAxis(kZ, views, kCorrelation));
  }
}

}  // namespace
}  // namespace soslam
