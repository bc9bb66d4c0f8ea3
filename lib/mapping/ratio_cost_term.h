// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "initialisation/ratio_rows.h"
#include "mapping/term.h"

namespace soslam {

// What a prior says of a landmark's ratios, as RatioTerm (upright.h) has it: quadratic in the
// logarithms of the half axes, which are what the landmark's variable holds.
class RatioCostTerm final : public Term {
 public:
  // `landmark` is the index of `landmark_in_world`.
  RatioCostTerm(int landmark, const double* landmark_in_world, const ShapePrior& prior);

  double Cost() const override;
  double Linearise(Hessian hessian, const TermPlaces& places) const override;

 private:
  Eigen::Vector2d Residuals() const;

  const double* landmark_in_world_;
  RatioRows rows_;
};

}  // namespace soslam
