// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "soslam/constraints/landmark_cost.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"

namespace soslam {

// Parameters of an object that stands upright on its support plane: yaw (rad, see UprightRotation),
// foot (projection of its centre onto the plane, along the ground's x and y, m), logarithms of its
// half axes, and height of its foot over the plane (m).
using UprightVector = Eigen::Matrix<double, 7, 1>;
using UprightJacobian = Eigen::Matrix<double, kLandmarkDof, 7>;  // d landmark / d UprightVector

// Parametrisation of the upright objects on a support plane, in the frame of the plane.
struct UprightParametrisation {
  explicit UprightParametrisation(const Plane& plane);

  Landmark LandmarkAt(const UprightVector& parameters, const ShapeExponents& shape_exponents,
                      RestingFace rests_on = RestingFace::kBottom) const;
  // Parameters of an upright landmark; for any other, those of the nearest one.
  UprightVector ComputeParameters(const Landmark& landmark) const;
  UprightJacobian ParameterJacobian(const Landmark& landmark) const;

  Eigen::Quaterniond rotation;  // UprightRotation(normal, 0)
  Eigen::Vector3d x, y, normal;
  Eigen::Vector3d origin;  // the plane's point nearest to its frame's origin
};

// A landmark and its cost.
struct UprightSolution {
  Landmark landmark;
  double cost;
};

// Levenberg-Marquardt over the parameters of an upright landmark; yaw and height are fixed, the
// height at zero, or free. None if the cost is not finite at the start.
struct UprightFreedom {
  bool yaw = true;
  bool height = false;
};
// `negligible_decrease`: see LevenbergMarquardtOptions; that of the costs if it is larger.
std::optional<UprightSolution> FitUpright(const Plane& plane, const Landmark& start,
                                          const LandmarkCosts& costs,
                                          const UprightFreedom& is_free = {},
                                          double negligible_decrease = 0.0);

// Levenberg-Marquardt over all nine parameters of a body that leans on a plane, from an upright
// landmark and from that landmark tilted to four sides. `costs` hold a LeaningTerm. Returns the
// landmark of lowest cost; none if that cost is not finite.
std::optional<UprightSolution> FitLeaning(const Plane& plane, const Landmark& upright,
                                          const LandmarkCosts& costs);

}  // namespace soslam
