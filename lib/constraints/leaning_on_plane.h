// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "constraints/parameters.h"
#include "geometry/angles.h"

namespace soslam {

// Standard deviations of a body that leans on its support plane.
struct LeaningSigmas {
  double angle_rad = 15.0 * kRadPerDeg;  // tilt about either horizontal axis
  double height_m = 0.002;               // of the lowest point over the plane
};

// Residuals of such a body: cosines of its x and y axes with the plane's normal, and the height of
// its lowest point, which the support function tells; each divided by its standard deviation.
struct LeaningOnPlane {
  LeaningOnPlane(const Landmark& landmark, const Plane& plane, const LeaningSigmas& sigmas);

  Eigen::Vector3d residuals;
  Eigen::Matrix<double, 3, kLandmarkDof> d_landmark;
  Eigen::Matrix3d d_normal;
  Eigen::Vector3d d_offset;
};

// LeaningOnPlane as a cost function. Blocks and `side` are those of UprightOnPlaneResidual.
class LeaningOnPlaneResidual final
    : public ceres::SizedCostFunction<3, kLandmarkSize, kNormalSize, kOffsetSize> {
 public:
  LeaningOnPlaneResidual(const ShapeExponents& shape_exponents, const LeaningSigmas& sigmas,
                         double side = 1.0)
      : shape_exponents_(shape_exponents), sigmas_(sigmas), side_(side) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  ShapeExponents shape_exponents_;
  LeaningSigmas sigmas_;
  double side_;
};

}  // namespace soslam
