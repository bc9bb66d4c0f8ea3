// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "constraints/tangency.h"
#include "initialisation/upright.h"

namespace soslam {

// The box of a detection in the ground frame of its object's support plane, where a yaw is a
// rotation about z.
struct BoxOnGround {
  // `edges` in the camera frame, `ground` in the reference frame.
  BoxOnGround(const std::array<BoxEdge, 4>& edges, const Rigid3d& camera_from_reference,
              const UprightGround& ground);

  // Depth (m) in the camera of a point in the ground frame.
  double DepthOf(const Eigen::Vector3d& point) const {
    return origin_depth + optical_axis.dot(point);
  }

  // The planes behind the edges (BoxEdge::plane) in the ground frame: normals as rows, and values
  // at the ground's origin (px m).
  Eigen::Matrix<double, 4, 3> normals;
  Eigen::Array4d at_origin;
  Eigen::Array4d sigma_px;
  Eigen::Array4d is_bound;       // 1 or 0
  Eigen::Vector3d optical_axis;  // of the camera, in the ground frame
  double origin_depth;           // depth of the ground's origin, m
};

// Cosine and sine of an object's yaw.
struct Heading {
  Heading() = default;
  explicit Heading(double yaw) : cosine(std::cos(yaw)), sine(std::sin(yaw)) {}

  // Rotates a direction from the ground frame into the object frame.
  Eigen::Vector3d TurnedBack(const Eigen::Vector3d& direction) const {
    return {cosine * direction.x() + sine * direction.y(),
            cosine * direction.y() - sine * direction.x(), direction.z()};
  }

  double cosine = 1.0;
  double sine = 0.0;
};

}  // namespace soslam
