// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "constraints/symmetry.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"
#include "symmetry/options.h"

namespace soslam {

// The symmetry cost of a landmark, eq. (16): the mean over the pairs of visible points of the
// squared descriptor difference (unit of the descriptor, squared). A mean, because how many pairs
// are visible depends on the yaw. None when fewer pairs count than the options ask for.
std::optional<double> SymmetryCost(const SymmetryImage& image, const Camera& camera,
                                   const Landmark& landmark_in_camera,
                                   const std::vector<Eigen::Vector2d>& samples,
                                   Descriptor descriptor, const SymmetryOptions& options);

// The symmetry cost of a landmark turned about its z axis, centre and half axes held (fig. 7).
struct YawProfile {
  std::vector<double> turns;  // rad, from the landmark's own yaw, over [-pi/2, pi/2)
  std::vector<double> costs;  // NaN where the cost is undefined
};
YawProfile ComputeYawProfile(const SymmetryImage& image, const Camera& camera,
                             const Landmark& landmark_in_camera,
                             const std::vector<Eigen::Vector2d>& samples, Descriptor descriptor,
                             const SymmetryOptions& options, double step);

// The turn of lowest cost: the best of the profile, refined on a grid of `resolution` (rad) between
// its neighbours. None when the whole profile is undefined.
std::optional<double> BestTurn(const YawProfile& profile, const SymmetryImage& image,
                               const Camera& camera, const Landmark& landmark_in_camera,
                               const std::vector<Eigen::Vector2d>& samples,
                               const SymmetryOptions& options, double resolution);

}  // namespace soslam
