// SPDX-License-Identifier: BSD-3-Clause
#include "planes/level_trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/angles.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr int kTurnFrames = 40;
constexpr double kDrift = 0.15 * kRadPerDeg;  // between two frames, all of it to one side

LevelTrajectory LevelInRoom(const std::vector<SegmentView>& views, double odometry_sigma_deg) {
  PlanesOptions options;
  options.view_correlation_deg = 0.0;
  options.odometry_rotation_sigma_deg = odometry_sigma_deg;
  return Level(views, CameraHolding::kLevel, options);
}

// A walk once around, cameras looking outwards and a little down.
std::vector<Rigid3d> TrueTrajectory() {
  std::vector<Rigid3d> poses;
  const Eigen::Quaterniond forward_x((Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished());
  for (int i = 0; i < kTurnFrames; ++i) {
    const double heading = 2.0 * std::numbers::pi * i / kTurnFrames;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
    poses.push_back({turn * forward_x * ExpRotation({-0.2, 0.0, 0.0}),
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

// Six verticals two to four metres in front of each true camera, seen exactly.
std::vector<SegmentView> ViewsOf(const std::vector<Rigid3d>& truth,
                                 const std::vector<Rigid3d>& odometry) {
  const Camera camera = TestCamera();
  std::vector<SegmentView> views;
  for (size_t i = 0; i < truth.size(); ++i) {
    const Rigid3d camera_from_world = truth[i].Inverse();
    SegmentView view{camera, {}, odometry[i]};
    while (view.segments.size() < 6) {
      const Eigen::Vector3d foot =
          truth[i] *
          Eigen::Vector3d(RandomUniform(-1, 1), RandomUniform(0, 0.7), RandomUniform(2, 4));
      const auto begin = camera.Project(camera_from_world * foot);
      const auto end = camera.Project(camera_from_world * (foot + 0.5 * Eigen::Vector3d::UnitZ()));
      if (begin && end) view.segments.push_back({*begin, *end});
    }
    views.push_back(view);
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
TEST(Level, TakesDriftOutOfATrajectory) {
  const std::vector<Rigid3d> truth = TrueTrajectory();
  const std::vector<Rigid3d> drifted = Drifted(truth, kDrift);
  const LevelTrajectory level = LevelInRoom(ViewsOf(truth, drifted), 0.2);
  ASSERT_EQ(level.world_from_camera.size(), truth.size());
  EXPECT_GT(WorstUp(truth, drifted, Eigen::Vector3d::UnitZ()), 5.0 * kRadPerDeg);
  EXPECT_LT(WorstUp(truth, level.world_from_camera, level.attitude.up_in_world),
            0.25 * kTurnFrames * kDrift);
  EXPECT_LT(WorstPosition(truth, level.world_from_camera), 0.5 * WorstPosition(truth, drifted));
  EXPECT_EQ(level.world_from_camera.front().translation, truth.front().translation);
  EXPECT_TRUE(level.world_from_camera.front().rotation.isApprox(truth.front().rotation, 1e-9));
}

// Nothing is to be taken out: what verticals say is what odometry says.
TEST(Level, LeavesATrajectoryWithoutDrift) {
  const std::vector<Rigid3d> truth = TrueTrajectory();
  const LevelTrajectory level = LevelInRoom(ViewsOf(truth, truth), 0.2);
  EXPECT_LT(WorstUp(truth, level.world_from_camera, level.attitude.up_in_world), 0.2 * kRadPerDeg);
  EXPECT_LT(WorstPosition(truth, level.world_from_camera), 0.02);
}

TEST(Level, TakesExactOdometryAsItIs) {
  const std::vector<Rigid3d> truth = TrueTrajectory();
  const std::vector<Rigid3d> drifted = Drifted(truth, kDrift);
  const LevelTrajectory level = LevelInRoom(ViewsOf(truth, drifted), 0.0);
  for (size_t i = 0; i < drifted.size(); ++i) {
    EXPECT_EQ(level.world_from_camera[i].translation, drifted[i].translation);
    EXPECT_EQ(level.world_from_camera[i].rotation.coeffs(), drifted[i].rotation.coeffs());
  }
}

}  // namespace
}  // namespace soslam
