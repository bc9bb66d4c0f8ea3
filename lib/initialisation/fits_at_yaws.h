// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "base/wide_loops.h"
#include "initialisation/box_on_ground.h"
#include "initialisation/semantic_table.h"

namespace soslam {

// The ratio prior's residuals, linear in the logarithms of the half axes:
// by_log_half_axes * log_half_axes - at_prior.
struct RatioRows {
  explicit RatioRows(const ShapePrior& prior);

  Eigen::Matrix<double, 2, 3> by_log_half_axes;
  Eigen::Vector2d at_prior;
  Eigen::Matrix3d information;
};

// Fits of a body at four yaws, side by side, to a box and to the prior of its ratios. No edge of
// the box may be a bound.
//
// The tangencies of a box's edges are linear in the body's foot, which is eliminated (variable
// projection; Golub and Pereyra, 1973): of the four residuals only that part counts which no foot
// explains, and the unknowns are the logarithms of the half axes.
class FitsAtYaws {
 public:
  static constexpr size_t kYaws = 4;

  // Keeps references to box and ratio.
  FitsAtYaws(const BoxOnGround& box, const RatioRows& ratio, double shape_exponent);

  // Where one of the fits starts (all four have to); tangent points at these depths (m).
  void Start(size_t place, const Eigen::Array4d& depths_m, const UprightVector& parameters);

  // Levenberg-Marquardt as MinimiseSquares does it.
  void Minimise(int max_iterations);

  // What is left then of tangencies and ratios. Not finite where the edges do not tell where the
  // foot is.
  double Cost(size_t place) const { return lanes_.cost[place]; }
  UprightVector Parameters(size_t place) const;

  // One number for each of the fits.
  struct Lanes {
    double shape_exponent;
    // Of residuals by edge: the normal in the object frame (see RoundedDirection), weight, value at
    // the ground's origin and how it changes with height, and the derivative by the foot, as
    // orthonormal columns.
    std::array<std::array<Four, 3>, 4> rounded;
    std::array<Four, 4> weight;
    std::array<double, 4> at_origin;
    std::array<double, 4> by_height;
    std::array<std::array<Four, 2>, 4> foot_basis;

    std::array<Four, 3> log_half_axes;
    std::array<Four, 2> foot;  // the best one's negative, in its basis
    Four cost;
  };

 private:
  const BoxOnGround& box_;
  const RatioRows& ratio_;
  Lanes lanes_;
  std::array<double, kYaws> yaw_;
  std::array<Eigen::Matrix2d, kYaws> foot_from_basis_;
};

}  // namespace soslam
