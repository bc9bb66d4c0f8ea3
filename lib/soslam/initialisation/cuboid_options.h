// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soslam/base/options.h"

namespace soslam {

// Proposals and scores of CubeSLAM; the defaults are those of its paper, where it has them.
struct CuboidOptions {
  int yaw_samples = 15;
  int corner_samples = 10;
  int edge_samples = 10;
  double min_segment_fraction = 0.25;
  double segment_angle_deg = 15.0;
  double angle_weight = 0.8;
  double shape_weight = 1.5;
  double shape_threshold = 1.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("CubeSLAM's cuboids");
    visit.Integer("yaw_samples", &yaw_samples, {1, 1000},
                  "yaws of proposals, over a quarter turn around the one that faces the camera");
    visit.Integer("corner_samples", &corner_samples, {1, 1000},
                  "columns within the box of the top corner farthest along the view");
    visit.Integer("edge_samples", &edge_samples, {1, 1000},
                  "points of each visible edge whose distance to image edges counts");
    visit.Real("min_segment_fraction", &min_segment_fraction, {0.0, 1.0},
               "shortest line segment that counts, as a fraction of the box's diagonal");
    visit.Real("segment_angle_deg", &segment_angle_deg, {0.0, 45.0},
               "largest angle between a line segment and the direction to its vanishing point; the "
               "error where an axis has no segments");
    visit.Real("angle_weight", &angle_weight, {0.0, 1e6},
               "weight w1 of the angles between line segments and edges, beside the distances");
    visit.Real("shape_weight", &shape_weight, {0.0, 1e6},
               "weight w2 of the footprint's shape, beside the distances");
    visit.Real("shape_threshold", &shape_threshold, {1.0, 1e6},
               "ratio sigma of the footprint's sides up to which its shape costs nothing");
  }
};

}  // namespace soslam
