// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/box.h"
#include "geometry/camera.h"

namespace soslam {

// How a lens bends the image of a pinhole camera: OpenCV's model with five coefficients, radial k1,
// k2, k3 and tangential p1, p2, dimensionless (docs.opencv.org, "Camera Calibration and 3D
// Reconstruction"). Pixels of images that the lens took are called distorted; the camera's own
// intrinsics hold before and after.
struct Distortion {
  double k1 = 0.0;
  double k2 = 0.0;
  double p1 = 0.0;
  double p2 = 0.0;
  double k3 = 0.0;

  bool operator==(const Distortion&) const = default;
};

// Where the lens puts what a pinhole camera would see at each of `pixels`.
std::vector<Eigen::Vector2d> DistortPixels(const Camera& camera, const Distortion& distortion,
                                           const std::vector<Eigen::Vector2d>& pixels);

// Where a pinhole camera would see what the lens puts at each of `distorted`. A pixel has none
// where the model cannot be inverted, which is so far out for lenses whose coefficients were not
// calibrated there.
std::vector<std::optional<Eigen::Vector2d>> UndistortPixels(
    const Camera& camera, const Distortion& distortion,
    const std::vector<Eigen::Vector2d>& distorted);

// The smallest upright box around the outline of `distorted`, undistorted. The edges of a box
// become curves, whose outermost points are often in their middle: a box around the four corners
// alone would cut off what touched the edge there. None when a point of the outline has no
// undistorted pixel.
std::optional<Box> UndistortBox(const Camera& camera, const Distortion& distortion,
                                const Box& distorted);

}  // namespace soslam
