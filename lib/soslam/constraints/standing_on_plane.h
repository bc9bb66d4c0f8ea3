// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <memory>

#include "soslam/constraints/parameters.h"
#include "soslam/geometry/angles.h"
#include "soslam/model/sequence.h"

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

// Prior on a plane's unit normal n, known before boxes are used: its cost is n^T information n / 2
// (positive semidefinite, 1 / rad^2). Residuals: 3, the information's square root times n. Block:
// the normal.
std::unique_ptr<ceres::CostFunction> PlaneNormalPrior(const Eigen::Matrix3d& information);

// Prior on a plane's height at a point p, known before boxes are used. Residual: (side n . p + d) /
// sigma. Blocks: the normal n that parallel planes share, and the offset d. `side` is -1 for a
// plane whose normal is opposite to the block, else 1.
class PlaneHeightResidual final : public ceres::SizedCostFunction<1, kNormalSize, kOffsetSize> {
 public:
  PlaneHeightResidual(const HeightPrior& prior, double side) : prior_(prior), side_(side) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  HeightPrior prior_;
  double side_;
};

}  // namespace soslam
