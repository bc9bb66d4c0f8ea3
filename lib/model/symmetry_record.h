// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace soslam {

// Result of the symmetry search on one observation's texture for the yaw of its object (figures 7
// and 8). Yaws are angles of the object's x axis about the support normal, in the camera frame, rad
// (see Yaw()).
struct SymmetryRecord {
  int frame_id = 0;
  int object_id = 0;
  std::vector<double> yaw;  // yaws of the grid
  // Name of the descriptor, or of the part of an orientation profile -> cost at each yaw of the
  // grid; NaN where too few pairs count.
  std::map<std::string, std::vector<double>> cost;
  // Used pixels and their mirror pixels at the refined yaw.
  std::vector<Eigen::Vector2f> samples;
  std::vector<Eigen::Vector2f> mirrored;
  // NaN when the observation has no landmark.
  double initial_yaw = std::numeric_limits<double>::quiet_NaN();
  double refined_yaw = std::numeric_limits<double>::quiet_NaN();
  std::optional<double> yaw_sigma;  // standard deviation of the refined yaw, if known
  // Number of vertical planes in which the visible texture is symmetric: 2 for xz and yz, 1 for xz
  // alone, 0 for none. Only for an orientation profile with texture.
  std::optional<int> mirror_planes;
  std::optional<double> true_yaw;  // where there is ground truth
};

}  // namespace soslam
