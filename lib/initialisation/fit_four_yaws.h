// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "initialisation/box_on_ground.h"
#include "initialisation/ratio_rows.h"
#include "initialisation/upright.h"

namespace soslam {

struct FitAtYaw {
  double cost;               // NaN if the foot is undetermined, or the cost not finite at the start
  UprightVector parameters;  // those of the start if the cost is NaN
  double nearest_depth_m;    // smallest of any point of the object; set unless the cost is NaN
};

// MinimiseSquares over the tangencies of a box without bound edges and its prior's ratios, with the
// yaws and tangent depths of the starts fixed. The four fits run at once (SIMD); a result does not
// depend on its lane or on the other fits, to the last bit.
//
// The tangencies of a box's edges are linear in the object's foot, which is eliminated (variable
// projection; Golub and Pereyra, 1973): only the component of the four residuals that no foot can
// fit contributes to the cost, and the unknowns are the logarithms of the half axes.
std::array<FitAtYaw, 4> FitFourYaws(const BoxOnGround& box, const RatioRows& ratio,
                                    double shape_exponent, int max_iterations,
                                    const std::array<StartAtYaw, 4>& starts);

}  // namespace soslam
