// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/tilt_drift.h"

#include <Eigen/Dense>
#include <algorithm>
#include <utility>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/landmark.h"

namespace soslam {
namespace {

constexpr double kMaxLevelTilt = 12.0 * kRadPerDeg;
constexpr int kMaxLevelRounds = 50;
constexpr double kLevelTolerance = 1e-7;  // rad

using Basis = Eigen::Matrix<double, 3, 2>;

Basis LevelAxes(const Eigen::Vector3d& up) {
  return UprightRotation(up, 0.0).toRotationMatrix().leftCols<2>();
}

// Chain of tilts, each with its own cost 0.5 tilt^T information tilt - tilt^T right_side, and tied
// to the previous one by `stiffness` (1 / rad^2). Returns them; `information` becomes that of each
// with all later ones.
std::vector<Eigen::Vector2d> SolveChain(double stiffness, std::vector<Eigen::Vector2d> right_side,
                                        std::vector<Eigen::Matrix2d>* information) {
  const auto tied = [&](size_t i) -> Eigen::Matrix2d {
    return (*information)[i] + stiffness * Eigen::Matrix2d::Identity();
  };
  for (size_t i = information->size() - 1; i > 0; --i) {
    const Eigen::Matrix2d share = stiffness * tied(i).inverse();
    (*information)[i - 1] += stiffness * (Eigen::Matrix2d::Identity() - share);
    right_side[i - 1] += share * right_side[i];
  }
  std::vector<Eigen::Vector2d> tilts = {information->front().inverse() * right_side[0]};
  for (size_t i = 1; i < right_side.size(); ++i) {
    tilts.push_back(tied(i).inverse() * (right_side[i] + stiffness * tilts.back()));
  }
  return tilts;
}

}  // namespace

TiltCorrectedTrajectory RemoveTiltDrift(const std::vector<SegmentView>& views,
                                        CameraOrientation orientation,
                                        const PlanesOptions& options) {
  const double correlation = options.upright.ViewCorrelation();
  const double vertical_sigma = options.verticals.Sigma();
  const double odometry_sigma = options.odometry_rotation_sigma_deg * kRadPerDeg;
  const std::vector<Rigid3d> poses = PosesOf(views);
  const UpPrior mean =
      WithVerticals(UpPriorFromCameras(poses, options.tilt, correlation, orientation), views,
                    vertical_sigma, correlation, kMaxLevelTilt);
  if (!(odometry_sigma > 0.0)) return {poses, mean};

  const std::vector<double> shares = CameraWeights(poses, correlation);
  const Basis level = LevelAxes(mean.up_in_world);
  const double stiffness = 1.0 / (odometry_sigma * odometry_sigma);
  std::vector<Eigen::Vector3d> ups(views.size(), mean.up_in_world);
  Eigen::Matrix2d information_of_first;
  for (int round = 0; round < kMaxLevelRounds; ++round) {
    std::vector<Eigen::Matrix2d> information;
    std::vector<Eigen::Vector2d> right_side;
    for (size_t i = 0; i < views.size(); ++i) {
      const Eigen::Matrix3d all =
          shares[i] * (UpPriorFromCameras({poses[i]}, options.tilt, 0.0, orientation).information +
                       InformationOfVerticals(views[i], vertical_sigma, ups[i]));
      information.push_back(level.transpose() * all * level);
      right_side.push_back(-level.transpose() * all * mean.up_in_world);
    }
    const std::vector<Eigen::Vector2d> tilts =
        SolveChain(stiffness, std::move(right_side), &information);
    information_of_first = information.front();
    double largest = 0.0;
    for (size_t i = 0; i < ups.size(); ++i) {
      const Eigen::Vector3d before = ups[i];
      ups[i] = (mean.up_in_world + level * tilts[i]).normalized();
      largest = std::max(largest, (ups[i] - before).norm());
    }
    if (largest < kLevelTolerance) break;
  }
  const Basis about_first = LevelAxes(ups.front());
  const Eigen::Matrix2d turned = about_first.transpose() * level;
  std::vector<Rigid3d> levelled = {poses.front()};
  for (size_t i = 1; i < poses.size(); ++i) {
    const Rigid3d motion = poses[i - 1].Inverse() * poses[i];
    const Eigen::Quaterniond turn = RotationBetween(ups[i], ups.front());
    levelled.push_back(
        {(turn * poses[i].rotation).normalized(), levelled.back() * motion.translation});
  }
  return {
      levelled,
      {about_first * (turned * information_of_first * turned.transpose()) * about_first.transpose(),
       ups.front()}};
}

}  // namespace soslam
