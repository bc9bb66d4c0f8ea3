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

// What all labels of one object say about it in the world.
struct TrackTruth {
  bool is_static = false;
  // The median of all views; of an object that is not static its first view.
  Landmark landmark_in_world;
  Plane plane_in_world;  // the landmark's bottom face
};

// `views`: at least one, in the order of time.
TrackTruth SummariseTrack(const std::vector<LabelledView>& views, const KittiOptions& options);

}  // namespace soslam
