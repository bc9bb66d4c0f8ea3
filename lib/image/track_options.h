// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"
#include "image/feature_tracks.h"

namespace soslam {

struct TrackOptions {
  FeatureTrackOptions features;
  int min_views = 3;
  double max_reprojection_error_px = 3.0;
  double min_angle_deg = 1.5;

  void Describe(OptionVisitor& visit) {
    features.Describe(visit);
    visit.Group("Points");
    visit.Integer("min_views", &min_views, {2, 1000}, "fewest images that a point is seen in");
    visit.Real("max_reprojection_error_px", &max_reprojection_error_px, {0.1, 1000.0},
               "an image point further from its point's projection is left out");
    visit.Real("min_angle_deg", &min_angle_deg, {0.01, 90.0},
               "smallest angle at a point between the directions to two cameras");
  }
};

}  // namespace soslam
