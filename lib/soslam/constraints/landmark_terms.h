// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>
#include <ceres/cubic_interpolation.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "soslam/constraints/landmark_cost.h"
#include "soslam/constraints/standing_on_plane.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"
#include "soslam/model/shape_prior.h"

namespace soslam {

// Prior of the ratios a / c and b / c as two residuals of unit variance that are linear in the
// logarithms of the half axes: that of the first ratio, and that of the second given the first
// (whitened by the inverse Cholesky factor of their covariance).
struct RatioRows {
  explicit RatioRows(const ShapePrior& prior);

  Eigen::Vector2d Residuals(const Eigen::Vector3d& log_half_axes) const {
    return d_log_half_axes * log_half_axes - at_prior;
  }

  Eigen::Matrix<double, 2, 3> d_log_half_axes;
  Eigen::Vector2d at_prior;
};

// The two residuals of RatioRows.
class RatioTerm final : public LandmarkTerm {
 public:
  explicit RatioTerm(const ShapePrior& prior) : rows_(prior) {}
  int NumResiduals() const override { return 2; }
  void Evaluate(const Landmark& landmark, Residuals residuals, Jacobian* jacobian) const override;

 private:
  RatioRows rows_;
};

// Residual of the logarithm of a length that is twice a half axis.
inline double LengthResidual(const LogNormal& length_m, double half_axis) {
  return std::log(2.0 * half_axis / length_m.median) / length_m.log_sigma;
}

// Residual of the length along an axis of the object frame: 2 c, the height of an object that
// stands, or one that is known of it.
class LengthTerm final : public LandmarkTerm {
 public:
  explicit LengthTerm(const LengthAlongAxis& length) : length_(length) {}
  int NumResiduals() const override { return 1; }
  void Evaluate(const Landmark& landmark, Residuals residuals, Jacobian* jacobian) const override;

 private:
  LengthAlongAxis length_;
};

// Term in one camera for a landmark in another frame; each residual has a Huber loss (none if delta
// is infinite), and the cost is multiplied by a weight.
class RobustViewTerm final : public LandmarkTerm {
 public:
  RobustViewTerm(std::unique_ptr<const LandmarkTerm> term, const Rigid3d& camera_from_reference,
                 double huber_delta, double weight)
      : term_(std::move(term)),
        camera_from_reference_(camera_from_reference),
        huber_delta_(huber_delta),
        root_weight_(std::sqrt(weight)) {}
  int NumResiduals() const override { return term_->NumResiduals(); }
  void Evaluate(const Landmark& landmark_in_reference, Residuals residuals,
                Jacobian* jacobian) const override;

 private:
  std::unique_ptr<const LandmarkTerm> term_;
  Rigid3d camera_from_reference_;
  double huber_delta_;
  double root_weight_;
};

// Weak prior of yaws along or across an axis of the scene, as for furniture: cost
// `weight` sin^2(2 d), with d the angle between yaw and axis, so at most `weight`.
class AxisTerm final : public LandmarkTerm {
 public:
  AxisTerm(const Plane& plane, const Eigen::Vector3d& axis, double weight);
  int NumResiduals() const override { return 1; }
  void Evaluate(const Landmark& landmark, Residuals residuals, Jacobian* jacobian) const override;

 private:
  Eigen::Vector3d normal_;
  double axis_yaw_;
  double amplitude_;
};

// Prior of an object's yaw (rad, see Yaw), modulo half a turn.
struct YawPrior {
  double yaw = 0.0;
  double sigma = 1.0;  // standard deviation, rad
};

// Residual of the yaw under its prior.
class YawTerm final : public LandmarkTerm {
 public:
  YawTerm(const Plane& plane, const YawPrior& prior) : normal_(plane.normal), prior_(prior) {}
  int NumResiduals() const override { return 1; }
  void Evaluate(const Landmark& landmark, Residuals residuals, Jacobian* jacobian) const override;

 private:
  Eigen::Vector3d normal_;
  YawPrior prior_;
};

// Cost over the yaw modulo half a turn, periodic: residual sqrt(2 cost). Between the given yaws it
// is cubic, and all of it is raised by as much as it falls below zero there: its square root would
// have a kink where it crosses zero.
class YawCostTerm final : public LandmarkTerm {
 public:
  // Costs, none below zero, at yaws (rad, see Yaw) of pi i / n.
  YawCostTerm(const Plane& plane, const std::vector<double>& costs);
  YawCostTerm(const YawCostTerm&) = delete;
  YawCostTerm& operator=(const YawCostTerm&) = delete;
  int NumResiduals() const override { return 1; }
  void Evaluate(const Landmark& landmark, Residuals residuals, Jacobian* jacobian) const override;

 private:
  Eigen::Vector3d normal_;
  std::vector<double> padded_;  // costs with two more at either end
  ceres::Grid1D<double> grid_;
  ceres::CubicInterpolator<ceres::Grid1D<double>> interpolator_;
  double raise_;
};

// The residuals of StandingOnPlane of a body that may lean, on a constant plane.
class LeaningTerm final : public LandmarkTerm {
 public:
  explicit LeaningTerm(const Plane& plane, const StandingSigmas& sigmas = StandingSigmas())
      : plane_(plane), sigmas_(sigmas) {}
  int NumResiduals() const override { return 3; }
  void Evaluate(const Landmark& landmark, Residuals residuals, Jacobian* jacobian) const override;

 private:
  Plane plane_;
  StandingSigmas sigmas_;
};

// A LandmarkTerm as a Ceres cost function, for a body of constant shape exponents. Residuals: those
// of the term. Block: landmark in the frame of the term.
class LandmarkTermResidual final : public ceres::CostFunction {
 public:
  LandmarkTermResidual(std::shared_ptr<const LandmarkTerm> term,
                       const ShapeExponents& shape_exponents)
      : term_(std::move(term)), shape_exponents_(shape_exponents) {
    set_num_residuals(term_->NumResiduals());
    *mutable_parameter_block_sizes() = {kLandmarkSize};
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  std::shared_ptr<const LandmarkTerm> term_;
  ShapeExponents shape_exponents_;
};

}  // namespace soslam
