// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

#include "soslam/base/quadratic_model.h"
#include "soslam/constraints/parameters.h"

namespace soslam {

// Cost of a landmark to second order in its nine parameters, in the order of kLandmarkDof.
using LandmarkModel = QuadraticModel<kLandmarkDof>;

// Cost of a landmark in some frame: half a sum of squared residuals of unit variance.
class LandmarkCost {
 public:
  virtual ~LandmarkCost() = default;
  // Cost without its constant part; not finite where it is undefined.
  virtual double Value(const Landmark& landmark) const = 0;
  // Adds the same to second order. If the cost is not finite, the derivatives added are
  // unspecified.
  virtual void AddTo(const Landmark& landmark, LandmarkModel* sum) const = 0;
  // Part of the cost that does not depend on the landmark, but may depend on what the cost was
  // constructed from.
  virtual double ConstantCost() const { return 0.0; }
  // True if many steps near a minimum gain little: where derivatives jump from pixel to pixel of an
  // image, or second derivatives are those of expectation maximisation.
  virtual bool ConvergesSlowly() const { return false; }
};

// A cost of few residuals, each with unit variance.
class LandmarkTerm : public LandmarkCost {
 public:
  static constexpr int kMaxResiduals = 4;
  using Residuals = Eigen::Ref<Eigen::VectorXd>;
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, kLandmarkDof, 0, kMaxResiduals>;

  virtual int NumResiduals() const = 0;
  // `jacobian` (NumResiduals() x 9) may be null.
  virtual void Evaluate(const Landmark& landmark, Residuals residuals,
                        Jacobian* jacobian) const = 0;

  double Value(const Landmark& landmark) const final;
  void AddTo(const Landmark& landmark, LandmarkModel* sum) const final;
};

using LandmarkCosts = std::vector<std::unique_ptr<const LandmarkCost>>;
double ConstantCost(const LandmarkCosts& costs);
// Sum of all values and constant costs.
double TotalCost(const LandmarkCosts& costs, const Landmark& landmark);
// Sum of all costs, without their constant parts, to second order.
LandmarkModel LineariseCosts(const LandmarkCosts& costs, const Landmark& landmark);
// Convergence tolerance of MinimiseSquares for these costs, relative to 1 + cost.
double NegligibleDecrease(const LandmarkCosts& costs);

// Cost in one camera, multiplied by a weight, for a landmark in another frame.
class ViewCost final : public LandmarkCost {
 public:
  ViewCost(std::unique_ptr<const LandmarkCost> in_camera, const Rigid3d& camera_from_reference,
           double weight);
  double Value(const Landmark& landmark_in_reference) const override;
  void AddTo(const Landmark& landmark_in_reference, LandmarkModel* sum) const override;
  double ConstantCost() const override { return weight_ * in_camera_->ConstantCost(); }
  bool ConvergesSlowly() const override { return in_camera_->ConvergesSlowly(); }

 private:
  std::unique_ptr<const LandmarkCost> in_camera_;
  Rigid3d camera_from_reference_;
  double weight_;
};

// d landmark in a camera / d landmark in another frame (9 x 9, parameters as kLandmarkDof).
Eigen::Matrix<double, kLandmarkDof, kLandmarkDof> LandmarkInCameraJacobian(
    const Eigen::Matrix3d& rotation_camera_from_reference);

// The cost of a landmark in one image, of texture, edges or points, as a few residuals in place of
// one for each of hundreds of pixels or points. Of a cost c with gradient g = J^T r and
// Gauss-Newton information H = J^T J = R^T R, these are nine residuals R^-T g with the Jacobian R,
// and one with a Jacobian of zero that holds the rest of the cost, sqrt(2 c - |R^-T g|^2): cost,
// gradient and information are those of all of them.
//
// Residuals: 10. Blocks: world_from_camera, landmark in the world. Without Jacobians, all of the
// cost is in the last residual.
class ImageResidual final
    : public ceres::SizedCostFunction<kLandmarkDof + 1, kPoseSize, kLandmarkSize> {
 public:
  ImageResidual(std::unique_ptr<const LandmarkCost> in_camera,
                const ShapeExponents& shape_exponents)
      : in_camera_(std::move(in_camera)), shape_exponents_(shape_exponents) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  std::unique_ptr<const LandmarkCost> in_camera_;
  ShapeExponents shape_exponents_;
};

}  // namespace soslam
