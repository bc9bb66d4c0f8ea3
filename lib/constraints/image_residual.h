// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <memory>
#include <utility>

#include "constraints/landmark_cost.h"
#include "constraints/parameters.h"

namespace soslam {

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
