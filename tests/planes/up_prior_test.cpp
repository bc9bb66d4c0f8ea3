// SPDX-License-Identifier: BSD-3-Clause
#include "planes/up_prior.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "geometry/angles.h"
#include "support/random.h"
#include "support/segment_views.h"

namespace soslam {
namespace {

constexpr double kRollSigma = 5.0 * kRadPerDeg;
constexpr double kPitchSigma = 30.0 * kRadPerDeg;
constexpr double kCorrelation = 20.0 * kRadPerDeg;

// Looks along a heading about z, this far downwards, x level.
Rigid3d LevelCamera(double heading, double downwards) {
  const Eigen::Vector3d forward(std::cos(heading) * std::cos(downwards),
                                std::sin(heading) * std::cos(downwards), -std::sin(downwards));
  const Eigen::Vector3d right(std::sin(heading), -std::cos(heading), 0.0);
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  return {Eigen::Quaterniond(axes), RandomVector(-1, 1)};
}

double AngleToUp(const std::vector<Rigid3d>& poses) {
  const Eigen::Vector3d up =
      UpPriorFromCameras(poses, kRollSigma, kPitchSigma, kCorrelation).up_in_world;
  EXPECT_NEAR(up.norm(), 1.0, 1e-12);
  return std::atan2(up.head<2>().norm(), up.z());
}

TEST(UpPriorFromCameras, OneCameraHasUpAboveIt) {
  EXPECT_NEAR(AngleToUp({LevelCamera(0.3, 0.0)}), 0.0, 1e-9);
  EXPECT_NEAR(AngleToUp({LevelCamera(0.3, 40.0 * kRadPerDeg)}), 40.0 * kRadPerDeg, 1e-9);
}

// Seen from two sides, the level x axes say what looking down hides: 40 degrees off in one heading
// only, the axes of the other heading hold up 36 times as firmly.
TEST(UpPriorFromCameras, HeadingsApartFindUpWhereverTheyLookDown) {
  std::vector<Rigid3d> poses;
  for (int i = 0; i < 8; ++i)
    poses.push_back(LevelCamera(i * 45.0 * kRadPerDeg, 40.0 * kRadPerDeg));
  EXPECT_NEAR(AngleToUp(poses), 0.0, 1e-9);
  poses.resize(3);
  EXPECT_LT(AngleToUp(poses), 3.0 * kRadPerDeg);
}

TEST(UpPriorFromCameras, ManyCamerasInOneDirectionCountAsOne) {
  const auto information = [](size_t count, double correlation) {
    return UpPriorFromCameras(std::vector<Rigid3d>(count, LevelCamera(1.0, 0.2)), kRollSigma,
                              kPitchSigma, correlation)
        .information;
  };
  EXPECT_LT((information(7, kCorrelation) - information(1, kCorrelation)).norm(), 1e-9);
  EXPECT_LT((information(7, 0.0) - 7.0 * information(1, 0.0)).norm(), 1e-9);
}

// A third of the cameras are rolled by 30 to 60 degrees.
TEST(RobustUpPriorFromCameras, SomeCamerasMayBeTurnedInAnyWay) {
  double plain_tilts = 0.0;
  for (int i = 0; i < 20; ++i) {
    std::vector<Rigid3d> even, turned;
    for (int k = 0; k < 24; ++k) {
      even.push_back(LevelCamera(RandomUniform(-3.1, 3.1), RandomUniform(0.1, 0.7)));
      turned.push_back(even.back());
      if (k % 3 != 0) continue;
      turned.back().rotation *=
          Eigen::Quaterniond(Eigen::AngleAxisd(RandomUniform(0.5, 1.0), Eigen::Vector3d::UnitZ()));
    }
    const auto robust = [](const std::vector<Rigid3d>& poses) {
      return RobustUpPriorFromCameras(poses, kRollSigma, kPitchSigma, kCorrelation,
                                      CameraHolding::kLevel);
    };
    const UpPrior up = robust(turned);
    EXPECT_GT(up.up_in_world.z(), std::cos(3.0 * kRadPerDeg));
    plain_tilts += AngleToUp(turned);
    EXPECT_GT(robust(even).up_in_world.z(), std::cos(0.5 * kRadPerDeg));
    EXPECT_LT(up.information.trace(), robust(even).information.trace());
  }
  EXPECT_GT(plain_tilts / 20, 5.0 * kRadPerDeg) << "where the loss matters";
}

// RotatedAboutZ about their optical axes, cameras that are held so have the up that they had
// before.
TEST(UpPriorFromCameras, RolledCamerasHaveTheUpOfLevelOnes) {
  constexpr std::array kRolls = {CameraHolding::kLevel, CameraHolding::kRolled90,
                                 CameraHolding::kRolled180, CameraHolding::kRolled270};
  for (int quarters = 0; quarters < 4; ++quarters) {
    const Eigen::Quaterniond roll(
        Eigen::AngleAxisd(quarters * 90.0 * kRadPerDeg, Eigen::Vector3d::UnitZ()));
    std::vector<Rigid3d> poses;
    for (int i = 0; i < 5; ++i) {
      const Rigid3d level = LevelCamera(i * 30.0 * kRadPerDeg, 20.0 * kRadPerDeg);
      poses.push_back({level.rotation * roll, level.translation});
    }
    const auto up =
        UpPriorFromCameras(poses, kRollSigma, kPitchSigma, kCorrelation, kRolls.at(quarters))
            .up_in_world;
    EXPECT_LT(std::atan2(up.head<2>().norm(), up.z()), 3.0 * kRadPerDeg) << quarters;
  }
}

TEST(UpPriorFromCameras, CamerasThatLookDownHaveUpBehindThem) {
  const std::vector<Rigid3d> poses = {LevelCamera(0.3, 80.0 * kRadPerDeg)};
  for (const auto holding : {CameraHolding::kLookingDown, CameraHolding::kLookingDownRolled90}) {
    const auto up =
        UpPriorFromCameras(poses, kRollSigma, kPitchSigma, kCorrelation, holding).up_in_world;
    EXPECT_NEAR(std::acos(up.z()), 10.0 * kRadPerDeg, 1e-9);
  }
}

constexpr double kSigma = 1.0 * kRadPerDeg;
constexpr double kSegmentCorrelation = 20.0 * kRadPerDeg;
constexpr double kMaxVerticalTilt = 12.0 * kRadPerDeg;

// Verticals, and twice as many edges of any direction.
std::vector<SegmentView> Room(const Eigen::Vector3d& up, int cameras, double arc) {
  std::vector<SegmentView> views;
  for (int i = 0; i < cameras; ++i) {
    std::vector<Eigen::Vector3d> directions(8, up);
    for (int k = 0; k < 16; ++k) directions.push_back(RandomRotation() * up);
    views.push_back(ViewOfEdges(CameraInRoom(arc * i / cameras), directions));
  }
  return views;
}

UpPrior HeldAttitude(const std::vector<SegmentView>& views) {
  std::vector<Rigid3d> poses;
  for (const SegmentView& view : views) poses.push_back(view.world_from_camera);
  return UpPriorFromCameras(poses, 5.0 * kRadPerDeg, 30.0 * kRadPerDeg, kSegmentCorrelation);
}

// Edges are exact, so only those of other directions and the cameras' attitude disturb: far less
// than one edge's standard deviation. Without verticals it is degrees.
TEST(WithVerticals, FindsUpAmongOtherEdges) {
  double before = 0.0;
  for (int i = 0; i < 10; ++i) {
    const auto views = Room(Eigen::Vector3d::UnitZ(), 12, 6.0);
    const UpPrior held = HeldAttitude(views);
    const auto found = WithVerticals(held, views, kSigma, kSegmentCorrelation, kMaxVerticalTilt);
    EXPECT_LT(AngleBetween(found.up_in_world, Eigen::Vector3d::UnitZ()), 0.3 * kRadPerDeg);
    before += AngleBetween(held.up_in_world, Eigen::Vector3d::UnitZ()) / 10;
  }
  EXPECT_GT(before, 0.5 * kRadPerDeg);
}

TEST(WithVerticals, LeavesTheAttitudeWhereThereIsNoEdge) {
  auto views = Room(Eigen::Vector3d::UnitZ(), 6, 3.0);
  for (SegmentView& view : views) view.segments.clear();
  const UpPrior held = HeldAttitude(views);
  const auto found = WithVerticals(held, views, kSigma, kSegmentCorrelation, kMaxVerticalTilt);
  EXPECT_LT((found.up_in_world - held.up_in_world).norm(), 1e-9);
  EXPECT_EQ(found.information, held.information);
}

// Up is what most edges say, but never far from how cameras are held.
TEST(WithVerticals, StaysNearTheAttitude) {
  const Eigen::Vector3d slanted(std::sin(0.7), 0.0, std::cos(0.7));
  const auto views = Room(slanted, 12, 6.0);
  const UpPrior held = HeldAttitude(views);
  const auto found = WithVerticals(held, views, kSigma, kSegmentCorrelation, kMaxVerticalTilt);
  EXPECT_LT(AngleBetween(found.up_in_world, held.up_in_world), 1.5 * kMaxVerticalTilt);
}

// The same edges again say nothing new.
TEST(WithVerticals, CamerasInOnePlaceCountAsOne) {
  const std::vector<SegmentView> one = {Room(Eigen::Vector3d::UnitZ(), 1, 0.0)};
  const std::vector<SegmentView> ten(10, one.front());
  const auto found = [&](const std::vector<SegmentView>& views) {
    return WithVerticals(HeldAttitude(views), views, kSigma, kSegmentCorrelation, kMaxVerticalTilt);
  };
  EXPECT_LT((found(one).up_in_world - found(ten).up_in_world).norm(), 1e-6);
  EXPECT_LT((found(one).information - found(ten).information).norm(),
            1e-6 * found(one).information.norm());
}

}  // namespace
}  // namespace soslam
