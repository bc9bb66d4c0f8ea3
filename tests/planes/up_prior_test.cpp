// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/up_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "soslam/geometry/angles.h"
#include "soslam/planes/scene_axis.h"
#include "soslam/planes/tilt_drift.h"
#include "support/looking_at.h"
#include "support/random.h"

namespace soslam {
namespace {

const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

// A camera anywhere in a room around the origin that looks somewhat downwards, not level.
Rigid3d CameraInRoom(double heading) {
  const Eigen::Quaterniond level =
      Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ())) *
      Eigen::Quaterniond((Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished());
  const Eigen::Vector3d attitude(RandomUniform(-0.5, -0.2), 0.0, RandomUniform(-0.1, 0.1));
  return {level * ExpRotation(attitude), RandomVector(-0.3, 0.3)};
}

// Edges along `directions` (or any, where there is none) as a camera sees them.
SegmentView ViewOfEdges(const Rigid3d& world_from_camera,
                        const std::vector<Eigen::Vector3d>& directions) {
  SegmentView view{TestCamera(), {}, world_from_camera};
  const Camera camera = TestCamera();
  const Rigid3d camera_from_world = world_from_camera.Inverse();
  for (const Eigen::Vector3d& direction : directions) {
    for (;;) {
      const Eigen::Vector3d point =
          world_from_camera *
          Eigen::Vector3d(RandomUniform(-1, 1), RandomUniform(-0.7, 0.7), RandomUniform(2.5, 4));
      const auto begin = camera.Project(camera_from_world * point);
      const auto end = camera.Project(camera_from_world * (point + 0.5 * direction));
      if (!begin || !end || (*end - *begin).norm() < 30.0) continue;
      view.segments.push_back({*begin, *end});
      break;
    }
  }
  return view;
}

const CameraTilt kTilt;
constexpr double kCorrelation = 20.0 * kRadPerDeg;

// Looks along a heading about z, this far downwards, x level.
Rigid3d LevelCamera(double heading, double downwards) {
  const Eigen::Vector3d forward(std::cos(heading) * std::cos(downwards),
                                std::sin(heading) * std::cos(downwards), -std::sin(downwards));
  const Eigen::Vector3d centre = RandomVector(-1, 1);
  return LookingAt(centre, centre + forward);
}

double AngleToUp(const std::vector<Rigid3d>& poses) {
  const Eigen::Vector3d up = UpPriorFromCameras(poses, kTilt, kCorrelation).up_in_world;
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
    return UpPriorFromCameras(std::vector<Rigid3d>(count, LevelCamera(1.0, 0.2)), kTilt,
                              correlation)
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
      return RobustUpPriorFromCameras(poses, kTilt, kCorrelation, CameraOrientation::kLevel);
    };
    const UpPrior up = robust(turned);
    EXPECT_GT(up.up_in_world.z(), std::cos(3.0 * kRadPerDeg));
    plain_tilts += AngleToUp(turned);
    EXPECT_GT(robust(even).up_in_world.z(), std::cos(0.5 * kRadPerDeg));
    EXPECT_LT(up.information.trace(), robust(even).information.trace());
  }
  EXPECT_GT(plain_tilts / 20, 5.0 * kRadPerDeg) << "where the loss matters";
}

// Turned about their optical axes, cameras that are held so have the up that they had before.
TEST(UpPriorFromCameras, RolledCamerasHaveTheUpOfLevelOnes) {
  for (int quarters = 0; quarters < 4; ++quarters) {
    const Eigen::Quaterniond roll(
        Eigen::AngleAxisd(quarters * 90.0 * kRadPerDeg, Eigen::Vector3d::UnitZ()));
    std::vector<Rigid3d> poses;
    for (int i = 0; i < 5; ++i) {
      const Rigid3d level = LevelCamera(i * 30.0 * kRadPerDeg, 20.0 * kRadPerDeg);
      poses.push_back({level.rotation * roll, level.translation});
    }
    const auto up = UpPriorFromCameras(poses, kTilt, kCorrelation, kCameraOrientations.at(quarters))
                        .up_in_world;
    EXPECT_LT(std::atan2(up.head<2>().norm(), up.z()), 3.0 * kRadPerDeg) << quarters;
  }
}

TEST(UpPriorFromCameras, CamerasThatLookDownHaveUpBehindThem) {
  const std::vector<Rigid3d> poses = {LevelCamera(0.3, 80.0 * kRadPerDeg)};
  for (const auto orientation :
       {CameraOrientation::kLookingDown, CameraOrientation::kLookingDownRolled90}) {
    const auto up = UpPriorFromCameras(poses, kTilt, kCorrelation, orientation).up_in_world;
    EXPECT_NEAR(std::acos(up.z()), 10.0 * kRadPerDeg, 1e-9);
  }
}

constexpr double kSigma = 1.0 * kRadPerDeg;
constexpr double kMaxVerticalTilt = 12.0 * kRadPerDeg;

// Cameras all around see each of these directions so often, among other edges of any direction.
std::vector<SegmentView> Room(const std::vector<Eigen::Vector3d>& directions, int often,
                              int others) {
  std::vector<SegmentView> views;
  for (int i = 0; i < 12; ++i) {
    std::vector<Eigen::Vector3d> seen;
    for (int k = 0; k < often; ++k) seen.insert(seen.end(), directions.begin(), directions.end());
    for (int k = 0; k < others; ++k) seen.emplace_back(RandomRotation() * kZ);
    views.push_back(ViewOfEdges(CameraInRoom(0.5 * i), seen));
  }
  return views;
}

UpPrior HeldUp(const std::vector<SegmentView>& views) {
  return UpPriorFromCameras(PosesOf(views), kTilt, kCorrelation);
}

// Edges are exact, so only those of other directions and the cameras' up prior disturb: far less
// than one edge's standard deviation. Without verticals it is degrees.
TEST(WithVerticals, FindsUpAmongOtherEdges) {
  double before = 0.0;
  for (int i = 0; i < 10; ++i) {
    const auto views = Room({kZ}, 8, 16);
    const UpPrior held = HeldUp(views);
    const auto found = WithVerticals(held, views, kSigma, kCorrelation, kMaxVerticalTilt);
    EXPECT_LT(AngleBetween(found.up_in_world, kZ), 0.3 * kRadPerDeg);
    before += AngleBetween(held.up_in_world, kZ) / 10;
  }
  EXPECT_GT(before, 0.5 * kRadPerDeg);
}

// Up is what most edges say, but never far from how cameras are held.
TEST(WithVerticals, StaysNearThePrior) {
  const Eigen::Vector3d slanted(std::sin(0.7), 0.0, std::cos(0.7));
  const auto views = Room({slanted}, 8, 16);
  const UpPrior held = HeldUp(views);
  const auto found = WithVerticals(held, views, kSigma, kCorrelation, kMaxVerticalTilt);
  EXPECT_LT(AngleBetween(found.up_in_world, held.up_in_world), 1.5 * kMaxVerticalTilt);
}

constexpr int kTurnFrames = 40;
constexpr double kDrift = 0.15 * kRadPerDeg;  // between two frames, all of it to one side

TiltCorrectedTrajectory RemoveDriftInRoom(const std::vector<SegmentView>& views,
                                          double odometry_sigma_deg) {
  PlanesOptions options;
  options.upright.view_correlation_deg = 0.0;
  options.odometry_rotation_sigma_deg = odometry_sigma_deg;
  return RemoveTiltDrift(views, CameraOrientation::kLevel, options);
}

// A walk once around, cameras looking outwards and a little down.
std::vector<Rigid3d> TrueTrajectory() {
  std::vector<Rigid3d> poses;
  for (int i = 0; i < kTurnFrames; ++i) {
    const double heading = 2.0 * std::numbers::pi * i / kTurnFrames;
    poses.push_back({LevelCamera(heading, 0.2).rotation,
                     {2.0 * std::cos(heading), 2.0 * std::sin(heading), 1.2}});
  }
  return poses;
}

// What odometry makes of it when every motion is turned by `drift` about the first camera's x.
std::vector<Rigid3d> Drifted(const std::vector<Rigid3d>& truth, double drift) {
  const Eigen::Vector3d axis = truth.front().rotation * Eigen::Vector3d::UnitX();
  std::vector<Rigid3d> drifted = {truth.front()};
  for (size_t i = 1; i < truth.size(); ++i) {
    Rigid3d motion = truth[i - 1].Inverse() * truth[i];
    motion.rotation = motion.rotation * ExpRotation(truth[i].rotation.conjugate() * (drift * axis));
    drifted.push_back(drifted.back() * motion);
  }
  return drifted;
}

// Six verticals in front of each true camera, seen exactly.
std::vector<SegmentView> ViewsOf(const std::vector<Rigid3d>& truth,
                                 const std::vector<Rigid3d>& odometry) {
  std::vector<SegmentView> views;
  for (size_t i = 0; i < truth.size(); ++i) {
    views.push_back(ViewOfEdges(truth[i], std::vector<Eigen::Vector3d>(6, kZ)));
    views.back().world_from_camera = odometry[i];
  }
  return views;
}

// The largest angle between the true up and that of a frame, both in the camera.
double WorstUp(const std::vector<Rigid3d>& truth, const std::vector<Rigid3d>& found,
               const Eigen::Vector3d& up_of_found) {
  double worst = 0.0;
  for (size_t i = 0; i < truth.size(); ++i) {
    worst = std::max(worst, AngleBetween(truth[i].rotation.conjugate() * Eigen::Vector3d::UnitZ(),
                                         found[i].rotation.conjugate() * up_of_found));
  }
  return worst;
}

double WorstPosition(const std::vector<Rigid3d>& truth, const std::vector<Rigid3d>& found) {
  double worst = 0.0;
  for (size_t i = 0; i < truth.size(); ++i) {
    worst = std::max(worst, (truth[i].translation - found[i].translation).norm());
  }
  return worst;
}

// Verticals that a camera sees ahead say how it rolls, hardly how it pitches: that is seen a
// quarter of the walk later. So what is left is at most the drift of a quarter of the walk.
TEST(RemoveTiltDrift, TakesDriftOutOfATrajectory) {
  const std::vector<Rigid3d> truth = TrueTrajectory();
  const std::vector<Rigid3d> drifted = Drifted(truth, kDrift);
  const TiltCorrectedTrajectory level = RemoveDriftInRoom(ViewsOf(truth, drifted), 0.2);
  ASSERT_EQ(level.world_from_camera.size(), truth.size());
  EXPECT_GT(WorstUp(truth, drifted, kZ), 5.0 * kRadPerDeg);
  EXPECT_LT(WorstUp(truth, level.world_from_camera, level.up_prior.up_in_world),
            0.25 * kTurnFrames * kDrift);
  EXPECT_LT(WorstPosition(truth, level.world_from_camera), 0.5 * WorstPosition(truth, drifted));
  EXPECT_EQ(level.world_from_camera.front().translation, truth.front().translation);
  EXPECT_TRUE(level.world_from_camera.front().rotation.isApprox(truth.front().rotation, 1e-9));
}

// Nothing is to be taken out: what verticals say is what odometry says.
TEST(RemoveTiltDrift, LeavesATrajectoryWithoutDrift) {
  const std::vector<Rigid3d> truth = TrueTrajectory();
  const TiltCorrectedTrajectory level = RemoveDriftInRoom(ViewsOf(truth, truth), 0.2);
  EXPECT_LT(WorstUp(truth, level.world_from_camera, level.up_prior.up_in_world), 0.2 * kRadPerDeg);
  EXPECT_LT(WorstPosition(truth, level.world_from_camera), 0.02);
}

TEST(RemoveTiltDrift, TakesExactOdometryAsItIs) {
  const std::vector<Rigid3d> truth = TrueTrajectory();
  const std::vector<Rigid3d> drifted = Drifted(truth, kDrift);
  const TiltCorrectedTrajectory level = RemoveDriftInRoom(ViewsOf(truth, drifted), 0.0);
  for (size_t i = 0; i < drifted.size(); ++i) {
    EXPECT_EQ(level.world_from_camera[i].translation, drifted[i].translation);
    EXPECT_EQ(level.world_from_camera[i].rotation.coeffs(), drifted[i].rotation.coeffs());
  }
}

// Edges along two horizontal directions at right angles and upwards.
std::vector<SegmentView> FurnishedRoom(double yaw, int others) {
  const Eigen::Vector3d along(std::cos(yaw), std::sin(yaw), 0.0);
  return Room({along, kZ.cross(along), kZ}, 6, others);
}

double OffAxis(const Eigen::Vector3d& axis, double yaw) {
  return std::abs(std::remainder(std::atan2(axis.y(), axis.x()) - yaw, 0.5 * std::numbers::pi));
}

// Edges are exact: only those of other directions, which fall near the axis by chance, disturb.
TEST(SceneAxis, IsTheDirectionOfMostEdges) {
  for (int i = 0; i < 20; ++i) {
    const double yaw = RandomUniform(-3.0, 3.0);
    const auto exact = SceneAxis(kZ, FurnishedRoom(yaw, 0), kCorrelation);
    ASSERT_TRUE(exact);
    EXPECT_LT(OffAxis(*exact, yaw), 1e-6);
    EXPECT_NEAR(exact->dot(kZ), 0.0, 1e-12);
    const auto among_others = SceneAxis(kZ, FurnishedRoom(yaw, 10), kCorrelation);
    ASSERT_TRUE(among_others);
    EXPECT_LT(OffAxis(*among_others, yaw), 0.5 * kRadPerDeg);
  }
}

TEST(SceneAxis, IsNoneWhereEdgesHaveNoCommonDirection) {
  EXPECT_FALSE(SceneAxis(kZ, {}, kCorrelation));
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(SceneAxis(kZ, Room({}, 0, 20), kCorrelation));
  }
}

}  // namespace
}  // namespace soslam
