// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "initialisation/multi_view.h"
#include "planes/camera_attitude.h"

namespace soslam {

// A direction of up in which an object has no body is worse than any in which it has one.
inline constexpr double kCostWithoutBody = 1e4;

// Of an object's boxes, with the best upright body of any height; none when there is none.
std::optional<double> CostOfUprightBody(const Eigen::Vector3d& up_in_world,
                                        MultiViewObservation observation);

// Of the directions that the cameras leave open, those in which upright bodies of any height
// explain the boxes best, lowest cost first: where bodies turn over to another of their axes the
// cost has several minima. Observations by object; none of those that do not take part.
std::vector<Eigen::Vector3d> SearchUp(
    const CameraAttitude& attitude,
    const std::vector<std::optional<MultiViewObservation>>& observations, int threads);

}  // namespace soslam
