// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "geometry/box.h"
#include "geometry/camera.h"

namespace soslam {

// Lens distortion in OpenCV's model: radial k1 to k6 (k4 to k6 in the denominator), tangential p1,
// p2 and thin prism s1 to s4, all dimensionless, and the tilt of the sensor tau_x, tau_y in radians
// (docs.opencv.org, "Camera Calibration and 3D Reconstruction"). Pixels of images that the lens
// took are called distorted; the intrinsics are the same before and after undistortion.
struct Distortion {
  double k1 = 0.0;
  double k2 = 0.0;
  double p1 = 0.0;
  double p2 = 0.0;
  double k3 = 0.0;
  double k4 = 0.0;
  double k5 = 0.0;
  double k6 = 0.0;
  double s1 = 0.0;
  double s2 = 0.0;
  double s3 = 0.0;
  double s4 = 0.0;
  double tau_x = 0.0;
  double tau_y = 0.0;

  bool operator==(const Distortion&) const = default;
};

// The coefficients in the order above, which is OpenCV's: the first 5, 8, 12 or 14, the smallest of
// these numbers that includes all that are not 0.
std::vector<double> DistortionCoefficients(const Distortion& distortion);
// The model with these coefficients; none unless there are 4, 5, 8, 12 or 14 of them.
std::optional<Distortion> DistortionOfCoefficients(std::span<const double> coefficients);

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
