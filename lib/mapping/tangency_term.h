// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "constraints/tangency.h"
#include "geometry/landmark.h"
#include "mapping/huber.h"
#include "mapping/term.h"

namespace soslam {

// The tangencies (tangency.h) of a detection's edges, each less a bias of the detector and under a
// Huber loss, all multiplied by a weight. The depth of a tangent point is that of the centre times
// what it is of it on `start_in_camera`, whose shape exponent is that of the body and whose centre
// is in front: with depths that stay as they were, a smaller world would have smaller residuals. A
// centre nearer than a tenth of that, or behind the camera, counts as if it were there. Edges whose
// tangent point is not in front of the camera at the start are left out. Variables: pose, landmark,
// bias.
class TangencyTerm final : public Term {
 public:
  struct Blocks {
    const double* world_from_camera;
    const double* landmark_in_world;
    const double* bias_px;
  };

  // `variables` are the indices of the blocks.
  TangencyTerm(const std::array<int, 3>& variables, const Blocks& blocks,
               const std::array<BoxEdge, 4>& edges, const Landmark& start_in_camera,
               double huber_delta, double weight);

  int NumEdges() const { return num_edges_; }

  double Cost() const override;
  double Linearise(Hessian hessian, const TermPlaces& places) const override;

 private:
  struct Edge {
    Eigen::Vector3d plane;  // in the camera frame; over sigma and the point's depth by the centre's
    double per_px;          // 1 / sigma
    int side;               // which one of the box
    bool is_bound;
  };
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
  double shape_exponent_;
  double least_depth_m_;  // of the centre
  HuberLoss loss_;
  double weight_;
  int num_edges_ = 0;
  std::array<Edge, 4> edges_;
};

}  // namespace soslam
