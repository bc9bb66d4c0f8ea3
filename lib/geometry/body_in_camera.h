// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "geometry/landmark.h"
#include "geometry/surface.h"

namespace soslam {

// A landmark's surface, met by many viewing rays.
struct BodyInCamera {
  explicit BodyInCamera(const Landmark& landmark_in_camera);

  // Where kBatchSize rays of the camera frame, (x, y, 1), meet the surface; all in the object
  // frame.
  void Meet(const double* x, const double* y, RayBatch* rays) const;

  Eigen::Matrix3d rotation;  // camera_from_object
  Eigen::Vector3d centre;
  Eigen::Vector3d camera_in_object;
  BodySurface surface;
};

}  // namespace soslam
