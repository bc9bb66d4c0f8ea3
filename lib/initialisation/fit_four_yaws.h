// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "initialisation/box_on_ground.h"
#include "initialisation/ratio_rows.h"
#include "initialisation/upright.h"

namespace soslam {

struct FitAtYaw {
  double cost;               // NaN where the edges do not tell the foot, or the start has no cost
  UprightVector parameters;  // those of the start then
  double nearest_depth_m;    // of the body's points; where there is a cost
};

// MinimiseSquares of what a box, none of whose edges is a bound, and its prior's ratios say, with
// the yaws of the starts and their tangent depths held. The four are fitted side by side, in wide
// registers; neither place nor neighbours change a fit by a bit.
//
// The tangencies of a box's edges are linear in the body's foot, which is eliminated (variable
// projection; Golub and Pereyra, 1973): of the four residuals only that part counts which no foot
// explains, and the unknowns are the logarithms of the half axes.
std::array<FitAtYaw, 4> FitFourYaws(const BoxOnGround& box, const RatioRows& ratio,
                                    double shape_exponent, int max_iterations,
                                    const std::array<StartAtYaw, 4>& starts);

}  // namespace soslam
