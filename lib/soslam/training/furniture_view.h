// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soslam/appearance/crop.h"
#include "soslam/training/furniture_model.h"

namespace soslam {

// A rendered crop of a model with what a head learns from it.
struct FurnitureView {
  Crop crop;
  double azimuth = 0.0;        // rad, see AzimuthOfCamera
  Eigen::Vector2d log_ratios;  // log(depth / height), log(width / height)
  // Share of the model's pixels that nothing hides; the border does not count.
  double visible_share = 1.0;
};

// A random view of a model among others in a random room: stretched, in random colours and light,
// from a random side, which `look` decides up to 25 degrees of azimuth, partly hidden or cut by the
// border, with the errors of cameras and of detectors' boxes. None if too little of it is seen.
std::optional<FurnitureView> RandomView(const FurnitureModel& target,
                                        const std::vector<const FurnitureModel*>& others, int side,
                                        Random look, Random* random);

// The model alone under one light from the camera, in its own colours, on grey; grey levels.
cv::Mat PlainView(const FurnitureModel& model, double azimuth, double elevation, int side);

}  // namespace soslam
