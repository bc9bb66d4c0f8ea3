// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"

namespace soslam {

// Options of the fit of an upright landmark to the box of one detection.
struct UprightOptions {
  double detection_sigma_fraction = 0.02;
  double axes_weight = 1.0;
  double yaw_grid_deg = 3.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("Upright bodies (any shape, on a grid of yaws)");
    visit.Real("detection_sigma_fraction", &detection_sigma_fraction, {1e-4, 1.0},
               "standard deviation of a detector's box edge, as a fraction of the box's width or "
               "height; at least 1 px");
    visit.Real(
        "axes_weight", &axes_weight, {0.0, 1e6},
        "cost (negative logarithm of a likelihood) of a yaw half-way between the axes of the "
        "scene, along which its straight edges lie; 0 if objects are not aligned with them");
    visit.Real("yaw_grid_deg", &yaw_grid_deg, {0.1, 45.0}, "grid of the sweep over half a turn");
  }
};

}  // namespace soslam
