// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/camera.h"
#include "geometry/landmark.h"

namespace soslam {

// A point of an object's surface that should be on an edge in the image.
struct ModelPoint {
  Eigen::Vector3d in_unit_body;  // in the object frame, divided by the half axes
  Eigen::Vector2d along;         // direction of the edge in the image, unit length
};

// Points about `spacing_px` apart along the visible edges of a landmark: the edges of its cuboid
// that belong to a visible face if it is boxy, its silhouette if it is rounder. None unless the
// whole landmark is in front of the camera.
std::vector<ModelPoint> VisibleModelPoints(const Camera& camera, const Landmark& landmark_in_camera,
                                           double spacing_px);

}  // namespace soslam
