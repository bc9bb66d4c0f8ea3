// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

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

}  // namespace soslam
