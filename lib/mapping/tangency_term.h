// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "mapping/huber.h"
#include "mapping/tangent_box.h"
#include "mapping/term.h"

namespace soslam {

// The tangencies (tangency.h) of a detection's edges, each less a bias of the detector and under a
// Huber loss, all multiplied by a weight. Variables: pose, landmark, bias.
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

  double Cost() const override;
  double Linearise(Hessian hessian, const TermPlaces& places) const override;

 private:
  using Edge = TangentBox::Edge;
  class View;
  struct Rows;
  class SecondDerivatives;

  // Adds derivatives in the object frame (second ones in the world; null for none) to where they
  // go.
  void Add(const Rows& rows, const Eigen::Matrix3d& world_from_object,
           const SecondDerivatives* second, const TermPlaces& places) const;

  void AddDepthProducts(const Rows& rows, const Eigen::Matrix3d& world_from_object,
                        const TermPlaces& places) const;

  Blocks blocks_;
  TangentBox box_;
  HuberLoss loss_;
  double weight_;
};

}  // namespace soslam
