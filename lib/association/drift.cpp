// SPDX-License-Identifier: BSD-3-Clause
#include "association/drift.h"

#include <algorithm>

namespace soslam {

Drift::Drift(const std::vector<Frame>& frames, double rotation_sigma_rad,
             double translation_sigma_m)
    : rotation_variance_(rotation_sigma_rad * rotation_sigma_rad),
      translation_variance_(translation_sigma_m * translation_sigma_m),
      origin_(frames.empty() ? Eigen::Vector3d::Zero() : frames[0].world_from_camera.translation),
      position_sums_(1, Eigen::Vector3d::Zero()),
      product_sums_(1, Eigen::Matrix3d::Zero()) {
  for (const Frame& frame : frames) {
    const Eigen::Vector3d position = frame.world_from_camera.translation - origin_;
    position_sums_.push_back(position_sums_.back() + position);
    product_sums_.push_back(product_sums_.back() + position * position.transpose());
  }
}

Eigen::Matrix3d Drift::PointCovariance(int frame_index, int other_frame_index,
                                       const Eigen::Vector3d& point_in_world) const {
  const auto [first, last] = std::minmax(frame_index, other_frame_index);
  // The motions between the two frames end at the frames first + 1 to last.
  const auto begin = static_cast<size_t>(first) + 1;
  const auto end = static_cast<size_t>(last) + 1;
  const double motions = last - first;
  const Eigen::Vector3d point = point_in_world - origin_;
  const Eigen::Vector3d positions = position_sums_[end] - position_sums_[begin];
  const Eigen::Matrix3d levers = motions * point * point.transpose() -
                                 point * positions.transpose() - positions * point.transpose() +
                                 product_sums_[end] - product_sums_[begin];
  // The sum of |lever|^2 I - lever lever^T, which is -Skew(lever)^2.
  return translation_variance_ * motions * Eigen::Matrix3d::Identity() +
         rotation_variance_ * (levers.trace() * Eigen::Matrix3d::Identity() - levers);
}

}  // namespace soslam
