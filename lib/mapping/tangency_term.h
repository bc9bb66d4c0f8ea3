// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "base/wide_loops.h"
#include "constraints/huber.h"
#include "mapping/tangent_box.h"
#include "mapping/term.h"

namespace soslam {

// The tangencies (tangency.h) of a detection's edges, each less a bias of the detector and under a
// Huber loss, all multiplied by a weight; side by side in wide registers. Infinite where any edge's
// excess is not finite, also that of a bound. Variables: pose, landmark, bias.
class TangencyTerm final : public Term {
 public:
  struct Blocks {
    const double* world_from_camera;
    const double* landmark_in_world;
    const double* bias_px;
  };

  // `variables` are the indices of the blocks.
  TangencyTerm(const std::array<int, 3>& variables, const Blocks& blocks, const TangentBox& box,
               double huber_delta, double weight);

  // Takes as long as to linearise.
  double Cost() const override { return Linearise(Hessian::kInformation, {}); }
  double Linearise(Hessian hessian, const TermPlaces& places) const override;

 private:
  Blocks blocks_;
  double shape_exponent_;
  double least_depth_m_;
  HuberLoss loss_;
  FourEdges edges_;                        // by side, in the camera frame
  alignas(kFourAlignment) Four per_px_{};  // 1 / sigma
};

}  // namespace soslam
