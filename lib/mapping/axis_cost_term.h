// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/plane.h"
#include "mapping/term.h"

namespace soslam {

// A weak preference for a yaw along or across a horizontal axis of the world, as AxisTerm
// (upright.h) has it, with its second derivative: half-way between the axes yaw is repelled, and
// J^T J, which knows of no such thing, would have steps fall short of the minimum.
class AxisCostTerm final : public Term {
 public:
  // `landmark` is the index of `landmark_in_world`.
  AxisCostTerm(int landmark, const double* landmark_in_world, const Plane& plane_in_world,
               double weight);

  double Cost() const override;
  double Linearise(Hessian hessian, const TermPlaces& places) const override;

 private:
  double AngleToAxis() const;

  const double* landmark_in_world_;
  Eigen::Vector3d normal_;
  double weight_;
};

}  // namespace soslam
