// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/camera.h"
#include "geometry/rigid3.h"
#include "image/edge_maps.h"
#include "planes/up_prior.h"

namespace soslam {

// Straight edges in one image.
struct SegmentView {
  Camera camera;
  std::vector<LineSegment> segments;
  Rigid3d world_from_camera;
};

// Information on up from one camera's segments, linearised at `up_in_world`, as
// UpPrior::information; see WithVerticals. The camera has weight 1.
Eigen::Matrix3d InformationOfVerticals(const SegmentView& view, double sigma,
                                       const Eigen::Vector3d& up_in_world);

// Adds vertical edges of man-made structures to the attitude. The plane through a camera's centre
// and the image of a vertical edge contains the up direction. Each segment is weighted by its
// length, relative to a tenth of the image's height; `sigma` (rad) is the standard deviation of the
// angle between up and its plane. The loss is bounded (Geman-McClure), so that segments off by more
// than three standard deviations, which are not vertical, have little influence. Cameras whose
// optical axes are closer than about `correlation_rad` see the same edges and count together as
// one. The result is linearised at the up direction of least cost within `max_tilt` (rad) of the
// attitude's own.
UpPrior WithVerticals(const UpPrior& attitude, const std::vector<SegmentView>& views, double sigma,
                      double correlation_rad, double max_tilt);

}  // namespace soslam
