// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "initialisation/multi_view.h"
#include "planes/up_prior.h"

namespace soslam {

// Cost of an object for an up direction in which it has no body; worse than any in which it has
// one.
inline constexpr double kCostWithoutBody = 1e4;

// Cost of an object's boxes with the best upright body of free height; none when there is none.
std::optional<double> CostOfUprightBody(const Eigen::Vector3d& up_in_world,
                                        MultiViewObservation observation);

// Local minima of up, among the directions that the cameras allow, in which upright bodies of free
// height fit the boxes best, lowest cost first. There are several minima, because bodies may stand
// on another of their axes. `observations`: per object; none for objects that do not take part.
std::vector<Eigen::Vector3d> SearchUp(
    const UpPrior& attitude, const std::vector<std::optional<MultiViewObservation>>& observations,
    int threads);

}  // namespace soslam
