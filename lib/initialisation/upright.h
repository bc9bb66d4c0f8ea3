// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "constraints/landmark_cost.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"

namespace soslam {

// Parameters of an object that stands upright on its support plane: yaw (rad, see UprightRotation),
// foot (projection of its centre onto the plane, along the ground's x and y, m), and logarithms of
// its half axes.
using UprightVector = Eigen::Matrix<double, 6, 1>;
using UprightJacobian = Eigen::Matrix<double, kLandmarkDof, 6>;  // d landmark / d UprightVector

// Ground frame of the upright objects on a support plane: frame_from_ground, with the frame of the
// plane.
struct UprightGround {
  explicit UprightGround(const Plane& plane);

  Landmark LandmarkAt(const UprightVector& parameters, const ShapeExponents& shape_exponents,
                      RestingFace rests_on = RestingFace::kBottom) const;
  // Parameters of a landmark that is upright on the plane; for any other, those of the nearest
  // upright landmark.
  UprightVector ParametersOf(const Landmark& landmark) const;
  UprightJacobian ParameterJacobian(const Landmark& landmark) const;
  // The same with the height of the foot over the plane (m) as seventh parameter.
  Eigen::Matrix<double, kLandmarkDof, 7> ParameterJacobianWithHeight(
      const Landmark& landmark) const;

  Eigen::Quaterniond rotation;  // UprightRotation(normal, 0)
  Eigen::Vector3d x, y, normal;
  Eigen::Vector3d origin;  // the plane's point nearest to its frame's origin
};

// Levenberg-Marquardt over the parameters of an upright landmark; yaw fixed or free. Returns the
// landmark and its total cost; none if the cost is not finite at the start.
struct UprightSolution {
  Landmark landmark;
  double cost;
};
std::optional<UprightSolution> FitUpright(const Plane& plane, const Landmark& start,
                                          const LandmarkCosts& costs, bool yaw_is_free);

// Levenberg-Marquardt over all nine parameters of a body that leans on a plane, from an upright
// landmark and from that landmark tilted to four sides. `costs` hold a LeaningTerm. Returns the
// landmark of lowest cost; none if that cost is not finite.
std::optional<UprightSolution> FitLeaning(const Plane& plane, const Landmark& upright,
                                          const LandmarkCosts& costs);

}  // namespace soslam
