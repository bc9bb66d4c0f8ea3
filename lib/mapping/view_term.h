// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>

#include "initialisation/landmark_cost.h"
#include "mapping/term.h"

namespace soslam {

// What one camera says of a landmark in its frame, first derivatives only. Variables: pose,
// landmark.
class ViewTerm final : public Term {
 public:
  struct Blocks {
    const double* world_from_camera;
    const double* landmark_in_world;
  };

  // `variables` are the indices of the blocks.
  ViewTerm(const std::array<int, 2>& variables, const Blocks& blocks, double shape_exponent,
           std::unique_ptr<const LandmarkCost> in_camera);

  double Cost() const override;
  double Linearise(Hessian hessian, const TermPlaces& places) const override;

 private:
  Blocks blocks_;
  double shape_exponent_;
  std::unique_ptr<const LandmarkCost> in_camera_;
};

}  // namespace soslam
