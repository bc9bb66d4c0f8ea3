// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/ground/horizontal_planes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "soslam/geometry/angles.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr double kUnit = 3.0;  // m, the distance of the points from cameras

// A floor at height 0, a table top at 0.7 m and a wall, in a world with this up direction.
class HorizontalPlanesTest : public testing::Test {
 protected:
  void AddPoint(const Eigen::Vector3d& in_room, double sigma_m = 0.003) {
    const double sigma = sigma_m / kUnit;
    points_.push_back({world_from_room_ * (in_room / kUnit + RandomNormalVector(sigma)),
                       sigma * sigma * Eigen::Matrix3d::Identity(),
                       {0, 1}});
  }

  void AddRoom() {
    for (int i = 0; i < 300; ++i) AddPoint({RandomUniform(-2, 2), RandomUniform(-2, 2), 0.0});
    for (int i = 0; i < 100; ++i) AddPoint({RandomUniform(0, 1), RandomUniform(0, 1), 0.7});
    for (int i = 0; i < 300; ++i) AddPoint({2.0, RandomUniform(-2, 2), RandomUniform(0, 2.5)});
  }

  // Known to this many degrees, and as far off.
  UpPrior CamerasUp(double off_deg) const {
    UpPrior up_prior;
    const double off = off_deg * kRadPerDeg;
    const Eigen::Vector3d up =
        Eigen::AngleAxisd(off, Eigen::Vector3d::UnitX()) * Eigen::Vector3d::UnitZ();
    up_prior.up_in_world = world_from_room_ * up;
    up_prior.information =
        (Eigen::Matrix3d::Identity() - up_prior.up_in_world * up_prior.up_in_world.transpose()) /
        (off * off);
    return up_prior;
  }

  Eigen::Quaterniond world_from_room_ = RandomRotation();
  std::vector<GroundPoint> points_;
};

TEST_F(HorizontalPlanesTest, FindsFloorAndTable) {
  AddRoom();
  const HorizontalPlanes found = FindHorizontalPlanes(points_, CamerasUp(5.0));
  EXPECT_LT(AngleBetweenDeg(found.up_in_world, world_from_room_ * Eigen::Vector3d::UnitZ()), 0.1);
  ASSERT_EQ(found.planes.size(), 2u);
  EXPECT_NEAR(found.planes[0].height, 0.0, 0.001);
  EXPECT_NEAR(found.planes[1].height, 0.7 / kUnit, 0.001);
  EXPECT_GT(found.planes[0].points_in_world.size(), 270u);
  EXPECT_LT(std::sqrt(found.tilt_covariance.trace()), 0.5 * kRadPerDeg);
}

TEST_F(HorizontalPlanesTest, AFloorAloneIsAPlane) {
  for (int i = 0; i < 300; ++i) AddPoint({RandomUniform(-2, 2), RandomUniform(-2, 2), 0.0});
  const HorizontalPlanes found = FindHorizontalPlanes(points_, CamerasUp(5.0));
  EXPECT_LT(AngleBetweenDeg(found.up_in_world, world_from_room_ * Eigen::Vector3d::UnitZ()), 0.1);
  ASSERT_EQ(found.planes.size(), 1u);
  EXPECT_EQ(found.planes[0].points_in_world.size(), 300u);
  EXPECT_LT(std::sqrt(found.planes[0].covariance(2, 2)), 0.01);
}

// The floor is known by points that are seen exactly, though most points are near a rough ramp.
TEST_F(HorizontalPlanesTest, ExactPointsTellMoreThanMany) {
  for (int i = 0; i < 200; ++i) AddPoint({RandomUniform(-2, 2), RandomUniform(-2, 2), 0.0});
  for (int i = 0; i < 500; ++i) {
    const double y = RandomUniform(-2, 2);
    AddPoint({RandomUniform(-2, 2), y, 0.7 + 0.14 * y + RandomUniform(-0.1, 0.1)}, 0.027);
  }
  const HorizontalPlanes found = FindHorizontalPlanes(points_, CamerasUp(5.0));
  EXPECT_LT(AngleBetweenDeg(found.up_in_world, world_from_room_ * Eigen::Vector3d::UnitZ()), 0.2);
}

TEST_F(HorizontalPlanesTest, CovarianceGrowsWithPlanesThatAreNotParallel) {
  AddRoom();
  const HorizontalPlanes even = FindHorizontalPlanes(points_, CamerasUp(5.0));
  for (int i = 0; i < 300; ++i) {  // a ramp of a degree beside the floor
    const double x = RandomUniform(-4, -2);
    AddPoint({x, RandomUniform(-2, 2), 0.0175 * (-2 - x)});
  }
  const HorizontalPlanes uneven = Refined(even, points_, CamerasUp(5.0));
  EXPECT_GT(uneven.tilt_covariance.trace(), 1.05 * even.tilt_covariance.trace());
}

TEST_F(HorizontalPlanesTest, RefinedUsesOnlyTheGivenPlanes) {
  AddRoom();
  HorizontalPlanes planes = FindHorizontalPlanes(points_, CamerasUp(5.0));
  ASSERT_EQ(planes.planes.size(), 2u);
  planes.planes.erase(planes.planes.begin());
  const HorizontalPlanes refined = Refined(planes, points_, CamerasUp(5.0));
  ASSERT_EQ(refined.planes.size(), 1u);
  EXPECT_NEAR(refined.planes[0].height, 0.7 / kUnit, 0.003);
  EXPECT_GT(refined.tilt_covariance.trace(), planes.tilt_covariance.trace());
}

TEST_F(HorizontalPlanesTest, WithoutPointsUpIsThatOfTheCameras) {
  const UpPrior up_prior = CamerasUp(5.0);
  const HorizontalPlanes found = FindHorizontalPlanes({}, up_prior);
  EXPECT_TRUE(found.planes.empty());
  EXPECT_TRUE(found.up_in_world.isApprox(up_prior.up_in_world));
  EXPECT_NEAR(std::sqrt(found.tilt_covariance(0, 0)), 5.0 * kRadPerDeg, 1e-6);
}

TEST_F(HorizontalPlanesTest, AWallAloneIsNoPlane) {
  for (int i = 0; i < 300; ++i) AddPoint({2.0, RandomUniform(-2, 2), RandomUniform(0, 2.5)});
  EXPECT_TRUE(FindHorizontalPlanes(points_, CamerasUp(3.0)).planes.empty());
}

}  // namespace
}  // namespace soslam
