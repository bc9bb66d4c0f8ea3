// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>

namespace soslam {

struct Sample {
  double value;
  Eigen::Vector2d gradient;  // d value / d pixel, of the bilinear patch (one-sided on its border)
};

// Bilinear interpolation of a CV_8UC1 or CV_32FC1 map. Domain: [0, width - 1] x [0, height - 1] of
// maps of at least 2 x 2 pixels; none outside it (no clamping, which would have zero gradients),
// and none where one of the four pixels around is not finite.
std::optional<Sample> SampleBilinear(const cv::Mat& map, const Eigen::Vector2d& pixel);
// True if a pixel is in that domain, whatever the map's values.
bool IsBetweenPixelCentres(const cv::Mat& map, const Eigen::Vector2d& pixel);

}  // namespace soslam
