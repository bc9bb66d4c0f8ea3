// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "dataset/import_options.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "geometry/rigid3.h"

namespace soslam {

// One labelled cuboid of a track.
struct LabelledView {
  Rigid3d world_from_camera;
  Landmark landmark_in_camera;
};

// Ground truth of one object in the world from all its labels.
struct TrackTruth {
  bool is_static = false;
  // Median of all views; the first view if the object is not static.
  Landmark landmark_in_world;
  Plane plane_in_world;  // the landmark's bottom face
};

// `views`: at least one, in temporal order.
TrackTruth SummariseTrack(const std::vector<LabelledView>& views, const KittiOptions& options);

}  // namespace soslam
