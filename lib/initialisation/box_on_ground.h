// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "base/wide_loops.h"
#include "constraints/tangency.h"
#include "initialisation/upright.h"

namespace soslam {

// A box in the frame of the ground that its object stands on, where a yaw turns about z.
struct BoxOnGround {
  // `ground` lives in the reference frame.
  BoxOnGround(const std::array<BoxEdge, 4>& edges, const Rigid3d& camera_from_reference,
              const UprightGround& ground);

  // In the camera, m.
  double DepthOf(const Eigen::Vector3d& point) const {
    return origin_depth + optical_axis.dot(point);
  }

  // The planes behind the edges: normals by row, and their values at the ground's origin.
  Eigen::Matrix<double, 4, 3> normals;
  Eigen::Array4d at_origin;
  Eigen::Array4d sigma_px;
  Eigen::Array4d is_bound;       // 1 or 0
  Eigen::Vector3d optical_axis;  // of the camera
  double origin_depth;           // of the ground's origin, m
};

// Where a body at a yaw faces.
struct Heading {
  Heading() = default;
  explicit Heading(double yaw) : cosine(std::cos(yaw)), sine(std::sin(yaw)) {}

  // A direction of the ground's frame as seen from the body.
  Eigen::Vector3d TurnedBack(const Eigen::Vector3d& direction) const {
    return {cosine * direction.x() + sine * direction.y(),
            cosine * direction.y() - sine * direction.x(), direction.z()};
  }

  double cosine = 1.0;
  double sine = 0.0;
};

// The same for four bodies.
struct alignas(kFourAlignment) FourHeadings {
  Four cosines{}, sines{};

  void Set(size_t place, const Heading& heading) {
    cosines[place] = heading.cosine;
    sines[place] = heading.sine;
  }
  SOSLAM_FORCE_INLINE ThreeFours TurnedBack(const Eigen::Vector3d& direction) const {
    return {cosines * direction.x() + sines * direction.y(),
            cosines * direction.y() - sines * direction.x(), Four{} + direction.z()};
  }
};

// A body, and how deep the points are where it touches the planes: where fits to a box start.
struct StartAtYaw {
  UprightVector parameters;
  Heading heading;  // of its yaw
  Eigen::Array4d depths_m;
};

}  // namespace soslam
