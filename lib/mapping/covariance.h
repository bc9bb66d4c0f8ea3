// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/problem.h>

#include <optional>
#include <utility>
#include <vector>

#include "model/estimates.h"

namespace soslam {

// The marginal covariances of landmark blocks at the solution, each over (rotation vector in the
// world frame, rad; centre, m; log half axes). They hold in so far as the residuals' sigmas do.
// None when the problem does not determine all of its variables (its Jacobian is rank deficient).
std::optional<std::vector<Covariance9>> LandmarkCovariances(
    const std::vector<const double*>& landmark_blocks, ceres::Problem* problem);

// The marginal covariances of planes, each given by its normal's and its offset's block, over
// (normal, offset): of rank 3, as the normal has unit length; zero for planes that are held. None
// as above.
std::optional<std::vector<Eigen::Matrix4d>> PlaneCovariances(
    const std::vector<std::pair<const double*, const double*>>& planes, ceres::Problem* problem);

}  // namespace soslam
