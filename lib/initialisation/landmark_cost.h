// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "geometry/landmark.h"
#include "geometry/mirror_mapping.h"
#include "geometry/rigid3.h"
#include "initialisation/quadratic_model.h"

namespace soslam {

// A cost of a landmark by its nine parameters, in the order of kLandmarkDof.
using LandmarkModel = QuadraticModel<kLandmarkDof>;

// Something that a landmark in a frame is fitted to: half a sum of squares with unit variance.
class LandmarkCost {
 public:
  virtual ~LandmarkCost() = default;
  // Without the constant cost; not finite where it is undefined.
  virtual double Value(const Landmark& landmark) const = 0;
  // Adds the same to second order. Where the cost is not finite, what it adds to the derivatives is
  // not specified.
  virtual void AddTo(const Landmark& landmark, LandmarkModel* sum) const = 0;
  // What does not change with the landmark, but may with what the cost was made for.
  virtual double ConstantCost() const { return 0.0; }
  // Whether its derivatives jump from pixel to pixel of an image.
  virtual bool HasKinks() const { return false; }
};

using LandmarkCosts = std::vector<std::unique_ptr<const LandmarkCost>>;
double ConstantCost(const LandmarkCosts& costs);
// Of all values, and the constant costs.
double TotalCost(const LandmarkCosts& costs, const Landmark& landmark);
// Where fits to them end: the least decrease of the cost, as a share of 1 + cost, that is worth a
// step of MinimiseSquares.
double NegligibleDecrease(const LandmarkCosts& costs);

// What one camera says, for a landmark in another frame, multiplied by a weight.
class ViewCost final : public LandmarkCost {
 public:
  ViewCost(std::unique_ptr<const LandmarkCost> in_camera, const Rigid3d& camera_from_reference,
           double weight);
  double Value(const Landmark& landmark_in_reference) const override;
  void AddTo(const Landmark& landmark_in_reference, LandmarkModel* sum) const override;
  double ConstantCost() const override { return weight_ * in_camera_->ConstantCost(); }
  bool HasKinks() const override { return in_camera_->HasKinks(); }

 private:
  std::unique_ptr<const LandmarkCost> in_camera_;
  Rigid3d camera_from_reference_;
  double weight_;
};

// d landmark in a camera / d landmark in another frame, by the parameters of both.
Eigen::Matrix<double, kLandmarkDof, kLandmarkDof> LandmarkInCameraBy(
    const Eigen::Matrix3d& rotation_camera_from_reference);

}  // namespace soslam
