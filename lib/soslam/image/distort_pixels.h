// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/distortion.h"

namespace soslam {

// Distorted positions of the pixels of a pinhole camera.
std::vector<Eigen::Vector2d> DistortPixels(const Camera& camera, const Distortion& distortion,
                                           const std::vector<Eigen::Vector2d>& pixels);

// Pixels of a pinhole camera for distorted pixels. None where the model cannot be inverted, which
// happens far outside the region in which the lens was calibrated.
std::vector<std::optional<Eigen::Vector2d>> UndistortPixels(
    const Camera& camera, const Distortion& distortion,
    const std::vector<Eigen::Vector2d>& distorted);

// The smallest upright box around the undistorted outline of `distorted`. The edges of a box become
// curves, whose outermost points are often in their middle: a box around the four corners alone
// would cut off the part of the object that touches the edge there. None when a point of the
// outline has no undistorted pixel.
std::optional<Box> UndistortBox(const Camera& camera, const Distortion& distortion,
                                const Box& distorted);

}  // namespace soslam
