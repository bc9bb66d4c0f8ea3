// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "constraints/symmetry.h"
#include "geometry/box.h"
#include "geometry/camera.h"
#include "orientation/options.h"
#include "symmetry/options.h"

namespace soslam {

// What the texture in one detection's box costs a landmark, as a negative logarithm of a
// likelihood: options.asymmetry_cost times the mean over the mirrored pairs on the landmark's own
// surface of d^2 / (d^2 + s^2), d the descriptor difference of eq. (16), s what counts as no
// symmetry; a pair that differs wholly counts no more than one that differs clearly. All of the
// cost where too few pairs are visible. The lowest over the places of the mirror plane that
// options.mirror_plane_range allows.
double AsymmetryCost(const SymmetryImage& image, const Camera& camera, const Box& box,
                     const Landmark& landmark_in_camera, const TextureOptions& options,
                     const SymmetryOptions& symmetry_options);

// The same for the back end, of the pairs that are visible on the start, the cost multiplied by
// `weight`. A pair that leaves the surface counts as asymmetric. Residuals: one per pair, none
// where too few are visible. Blocks: world_from_camera, landmark in the world. Not for kBrief,
// which has no derivative.
class AsymmetryResidual final : public ceres::CostFunction {
 public:
  AsymmetryResidual(std::shared_ptr<const SymmetryImage> image, const Camera& camera,
                    const Box& box, const Landmark& start_in_camera, const TextureOptions& options,
                    const SymmetryOptions& symmetry_options, double weight);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  std::shared_ptr<const SymmetryImage> image_;
  Camera camera_;
  Descriptor descriptor_;
  std::vector<Eigen::Vector2d> pixels_;
  double shape_exponent_;
  double scale_;  // s
  double amplitude_;
};

}  // namespace soslam
