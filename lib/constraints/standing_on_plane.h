// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "constraints/parameters.h"
#include "geometry/angles.h"

namespace soslam {

// Standard deviations of a body on its support plane; by default those of one that may lean.
struct StandingSigmas {
  double angle_rad = 15.0 * kRadPerDeg;  // tilt about either horizontal axis
  double height_m = 0.002;               // of the lowest point over the plane
};

// Residuals of a body on its support plane, eq. (5)-(8): cosines of its x and y axes with the
// plane's normal, and the height of its lowest point over the plane in place of pi^T Q* pi; each
// divided by its standard deviation. In metres, so that a flat object is constrained as strongly as
// a high one. The lowest point is that of the support function if the body may lean, else the
// half axis c below the centre.
struct StandingOnPlane {
  StandingOnPlane(const Landmark& landmark, const Plane& plane, const StandingSigmas& sigmas,
                  bool may_lean);

  Eigen::Vector3d residuals;
  Eigen::Matrix<double, 3, kLandmarkDof> d_landmark;
  Eigen::Matrix3d d_normal;
  Eigen::Vector3d d_offset;
};

// StandingOnPlane as a cost function. Blocks: landmark in the world; unit normal and offset of the
// plane in the world. `side` is 1, or -1 if the plane's normal is opposite to the block's, as for a
// ceiling that shares the floor's normal.
class StandingOnPlaneResidual final
    : public ceres::SizedCostFunction<3, kLandmarkSize, kNormalSize, kOffsetSize> {
 public:
  StandingOnPlaneResidual(const ShapeExponents& shape_exponents, const StandingSigmas& sigmas,
                          bool may_lean, double side = 1.0)
      : shape_exponents_(shape_exponents), sigmas_(sigmas), may_lean_(may_lean), side_(side) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  ShapeExponents shape_exponents_;
  StandingSigmas sigmas_;
  bool may_lean_;
  double side_;
};

}  // namespace soslam
