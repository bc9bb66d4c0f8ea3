// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "constraints/symmetry.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"
#include "orientation/options.h"

namespace soslam {

// The symmetry cost of a landmark, eq. (16) under a robust kernel in its linear part: the mean of
// the absolute descriptor difference (unit of the descriptor) over the pairs of visible points.
// Absolute, because pairs for which the approximation of eq. (20) fails are few outliers; a mean,
// because the number of visible pairs depends on the yaw. None when there are fewer pairs than the
// options require. One cost for each descriptor, of which there is at least one.
std::vector<std::optional<double>> SymmetryCosts(const SymmetryImage& image, const Camera& camera,
                                                 const Landmark& landmark_in_camera,
                                                 const std::vector<Eigen::Vector2d>& samples,
                                                 const std::vector<Descriptor>& descriptors,
                                                 const SymmetryOptions& options);

// The symmetry costs of a landmark rotated about its z axis; centre and half axes are fixed (fig.
// 7).
struct YawProfile {
  std::vector<double> turns;               // rad, from the landmark's own yaw, over [-pi/2, pi/2)
  std::vector<std::vector<double>> costs;  // by descriptor and turn; NaN where undefined
};
YawProfile ComputeYawProfile(const SymmetryImage& image, const Camera& camera,
                             const Landmark& landmark_in_camera,
                             const std::vector<Eigen::Vector2d>& samples,
                             const std::vector<Descriptor>& descriptors,
                             const SymmetryOptions& options, double step);

// The rotation of lowest cost, at most `range` either way: the best of a grid of `step`, refined on
// a grid of `resolution` between its neighbours (all rad). None when the cost is undefined on the
// whole grid.
struct BestTurn {
  double turn;
  double cost;
};
std::optional<BestTurn> FindBestTurn(const SymmetryImage& image, const Camera& camera,
                                     const Landmark& landmark_in_camera,
                                     const std::vector<Eigen::Vector2d>& samples,
                                     const SymmetryOptions& options, double range, double step,
                                     double resolution);

}  // namespace soslam
