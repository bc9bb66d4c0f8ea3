// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"

namespace soslam {

// Direction in which a camera sees a box.
struct BoxDirection {
  Eigen::Vector3d ray_in_camera;  // unit vector through the box's centre
  double elevation = 0.0;         // of the camera above the box: rad, positive seen from above
  double log_aspect = 0.0;        // log(width / height) of the box as a level camera sees it
};

// A square view of a box by a virtual camera that looks at the box's centre and has no roll, with a
// margin about the box. What lies outside of the image is grey.
struct Crop {
  cv::Mat image;  // side x side, blue, green, red
  BoxDirection direction;
};

// `up_in_camera` is a unit vector, `image` undistorted, of 8-bit blue, green, red.
Crop RenderCrop(const cv::Mat& image, const Camera& camera, const Box& box,
                const Eigen::Vector3d& up_in_camera, int side);

}  // namespace soslam
