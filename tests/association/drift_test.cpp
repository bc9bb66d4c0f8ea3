// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "association/fit_object.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr double kRotationSigma = 0.004;
constexpr double kTranslationSigma = 0.01;

std::vector<Frame> RandomWalk(int frames) {
  std::vector<Frame> walk(static_cast<size_t>(frames));
  for (size_t i = 1; i < walk.size(); ++i) {
    walk[i].world_from_camera =
        walk[i - 1].world_from_camera *
        Rigid3d{ExpRotation(RandomVector(-0.1, 0.1)), RandomVector(-0.3, 0.3)};
  }
  return walk;
}

TEST(DriftTest, OneMotionMovesAPointByItsErrorAndItsLever) {
  std::vector<Frame> frames(2);
  frames[1].world_from_camera.translation = {1.0, 0.0, 0.0};
  const Drift drift(frames, kRotationSigma, kTranslationSigma);
  // Two metres ahead of the second camera, along x: a turn moves the point along y and z.
  const Eigen::Matrix3d covariance = drift.PointCovariance(0, 1, {3.0, 0.0, 0.0});
  const Eigen::Vector3d variances(1e-4, 1e-4 + 4.0 * 1.6e-5, 1e-4 + 4.0 * 1.6e-5);
  EXPECT_TRUE(covariance.isApprox(Eigen::Matrix3d(variances.asDiagonal()), 1e-12)) << covariance;
}

TEST(DriftTest, IsNothingWithinAFrameAndTheSameBothWays) {
  const std::vector<Frame> frames = RandomWalk(9);
  const Drift drift(frames, kRotationSigma, kTranslationSigma);
  const Eigen::Vector3d point(2.0, -1.0, 0.5);
  EXPECT_EQ(drift.PointCovariance(4, 4, point).norm(), 0.0);
  EXPECT_EQ(drift.PointCovariance(2, 7, point), drift.PointCovariance(7, 2, point));
}

TEST(DriftTest, IsTheSpreadOfSimulatedOdometry) {
  constexpr int kFrames = 12;
  constexpr int kRuns = 4000;
  const std::vector<Frame> frames = RandomWalk(kFrames);
  const Eigen::Vector3d point(1.5, -2.0, 1.0);
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) -> Eigen::Vector3d {
    auto& random = TestRandom();
    const double x = normal(random), y = normal(random), z = normal(random);
    return sigma * Eigen::Vector3d(x, y, z);
  };
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d point_in_first = frames[0].world_from_camera.Inverse() * point;
  const Rigid3d& last = frames.back().world_from_camera;
  for (int run = 0; run < kRuns; ++run) {
    Rigid3d last_from_first;  // as the odometry says
    for (size_t i = 1; i < frames.size(); ++i) {
      const Rigid3d motion =
          frames[i].world_from_camera.Inverse() * frames[i - 1].world_from_camera;
      const Rigid3d error{ExpRotation(noise(kRotationSigma)), noise(kTranslationSigma)};
      last_from_first = error * motion * last_from_first;
    }
    const Eigen::Vector3d offset = last * (last_from_first * point_in_first) - point;
    spread += offset * offset.transpose() / kRuns;
  }
  const Eigen::Matrix3d expected =
      Drift(frames, kRotationSigma, kTranslationSigma).PointCovariance(0, kFrames - 1, point);
  // A sample covariance of 4000 is good to about 1 / sqrt(2000) of each variance; four times that.
  EXPECT_LT((spread - expected).norm(), 0.09 * expected.norm()) << spread << "\n\n" << expected;
}

}  // namespace
}  // namespace soslam
