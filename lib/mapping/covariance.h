// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/problem.h>

#include <optional>
#include <vector>

#include "model/estimates.h"

namespace soslam {

// The marginal covariances of landmark blocks at the solution, each over (rotation vector in the
// world frame, rad; centre, m; log half axes). They hold in so far as the residuals' sigmas do.
// None when the problem does not determine all of its variables (its Jacobian is rank deficient).
std::optional<std::vector<Covariance9>> LandmarkCovariances(
    const std::vector<const double*>& landmark_blocks, ceres::Problem* problem);

}  // namespace soslam
