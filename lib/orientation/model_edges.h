// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/camera.h"
#include "geometry/landmark.h"

namespace soslam {

// A point of a body where an edge is to be expected in the image.
struct ModelPoint {
  Eigen::Vector3d in_unit_body;  // in the object frame, divided by the half axes
  Eigen::Vector2d along;         // direction of the edge in the image, unit length
};

// Points about `spacing_px` apart along the visible edges of a landmark: of a boxy one the edges of
// its cuboid that belong to a face that the camera sees, of a rounder one its outline. None unless
// the whole landmark is in front of the camera.
std::vector<ModelPoint> VisibleModelPoints(const Camera& camera, const Landmark& landmark_in_camera,
                                           double spacing_px);

}  // namespace soslam
