// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "geometry/landmark.h"
#include "geometry/surface.h"

namespace soslam {

// A landmark's surface in the camera frame, for intersection with many viewing rays.
struct BodyInCamera {
  explicit BodyInCamera(const Landmark& landmark_in_camera);

  // Intersects kBatchSize rays (x, y, 1) of the camera frame with the surface. All of `rays` is in
  // the object frame.
  void Meet(const double* x, const double* y, RayBatch* rays) const;

  Eigen::Matrix3d rotation;  // camera_from_object
  Eigen::Vector3d centre;
  Eigen::Vector3d camera_in_object;
  BodySurface surface;
};

}  // namespace soslam
