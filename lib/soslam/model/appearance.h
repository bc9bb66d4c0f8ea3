// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

namespace soslam {

// Bins of azimuth, about 0, 10, ... 350 degrees.
inline constexpr int kAzimuthBins = 36;
using AzimuthCosts = Eigen::Matrix<float, kAzimuthBins, 1>;

// Likelihood of log(depth / height) and log(width / height), which are independent of each other:
// means and standard deviations.
struct LogRatios {
  Eigen::Vector2f mean;
  Eigen::Vector2f sigma;
};

// Evidence of the picture in a box about the object.
struct BoxAppearance {
  // Negative logarithms of the likelihoods of the azimuths from which the object is seen: the angle
  // about its z axis from its x axis to the direction towards the camera, against the ray through
  // the box's centre. The lowest is zero, as all are where none is told.
  AzimuthCosts azimuth_costs;
  std::optional<LogRatios> log_ratios;
  // Errors of pictures from directions that are closer than about this angle are the same.
  float direction_correlation_deg = 0.0F;

  bool TellsAzimuth() const { return azimuth_costs.maxCoeff() > 0.0F; }
};

}  // namespace soslam
