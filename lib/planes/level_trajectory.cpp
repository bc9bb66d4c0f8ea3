// SPDX-License-Identifier: BSD-3-Clause
#include "planes/level_trajectory.h"

#include <Eigen/Dense>
#include <algorithm>

#include "geometry/angles.h"
#include "geometry/landmark.h"
#include "planes/poses.h"

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
// to the previous one.
class Chain {
 public:
  // `stiffness`: 1 / rad^2.
  Chain(std::vector<Eigen::Matrix2d> information, std::vector<Eigen::Vector2d> right_side,
        double stiffness)
      : information_(std::move(information)),
        right_side_(std::move(right_side)),
        stiffness_(stiffness) {
    // Eliminates from the last: adds the information of all later tilts to each.
    for (size_t i = information_.size() - 1; i > 0; --i) {
      const Eigen::Matrix2d share = stiffness_ * Tied(i).inverse();
      information_[i - 1] += stiffness_ * (Eigen::Matrix2d::Identity() - share);
      right_side_[i - 1] += share * right_side_[i];
    }
  }

  const Eigen::Matrix2d& InformationOfFirst() const { return information_.front(); }

  std::vector<Eigen::Vector2d> Solve() const {
    std::vector<Eigen::Vector2d> tilts = {information_[0].inverse() * right_side_[0]};
    for (size_t i = 1; i < information_.size(); ++i) {
      tilts.push_back(Tied(i).inverse() * (right_side_[i] + stiffness_ * tilts.back()));
    }
    return tilts;
  }

 private:
  Eigen::Matrix2d Tied(size_t i) const {
    return information_[i] + stiffness_ * Eigen::Matrix2d::Identity();
  }

  std::vector<Eigen::Matrix2d> information_;
  std::vector<Eigen::Vector2d> right_side_;
  double stiffness_;
};

std::vector<Rigid3d> Joined(const std::vector<Rigid3d>& drifted,
                            const std::vector<Eigen::Vector3d>& ups) {
  std::vector<Rigid3d> levelled = {drifted.front()};
  for (size_t i = 1; i < drifted.size(); ++i) {
    const Rigid3d motion = drifted[i - 1].Inverse() * drifted[i];
    const Eigen::Quaterniond turn = RotationBetween(ups[i], ups.front());
    levelled.push_back(
        {(turn * drifted[i].rotation).normalized(), levelled.back() * motion.translation});
  }
  return levelled;
}

}  // namespace

LevelTrajectory Level(const std::vector<SegmentView>& views, CameraHolding holding,
                      const PlanesOptions& options) {
  const double correlation = options.view_correlation_deg * kRadPerDeg;
  const double vertical_sigma = options.vertical_sigma_deg * kRadPerDeg;
  const double odometry_sigma = options.odometry_rotation_sigma_deg * kRadPerDeg;
  const auto held = [&](const std::vector<Rigid3d>& poses, double correlation_rad) {
    return UpPriorFromCameras(poses, options.camera_roll_sigma_deg * kRadPerDeg,
                              options.camera_pitch_sigma_deg * kRadPerDeg, correlation_rad,
                              holding);
  };
  const std::vector<Rigid3d> poses = PosesOf(views);
  const UpPrior mean =
      WithVerticals(held(poses, correlation), views, vertical_sigma, correlation, kMaxLevelTilt);
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
          shares[i] * (held({poses[i]}, 0.0).information +
                       InformationOfVerticals(views[i], vertical_sigma, ups[i]));
      information.push_back(level.transpose() * all * level);
      right_side.push_back(-level.transpose() * all * mean.up_in_world);
    }
    const Chain chain(std::move(information), std::move(right_side), stiffness);
    information_of_first = chain.InformationOfFirst();
    const std::vector<Eigen::Vector2d> tilts = chain.Solve();
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
  return {
      Joined(poses, ups),
      {about_first * (turned * information_of_first * turned.transpose()) * about_first.transpose(),
       ups.front()}};
}

}  // namespace soslam
