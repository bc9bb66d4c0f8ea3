// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/camera.h"
#include "geometry/rigid3.h"
#include "image/line_segments.h"
#include "planes/camera_attitude.h"

namespace soslam {

// The straight edges that one camera sees.
struct SegmentView {
  Camera camera;
  std::vector<LineSegment> segments;
  Rigid3d world_from_camera;
};

// What one camera's segments say about up, near `up_in_world`, as CameraAttitude::information; see
// WithVerticals. The camera counts as one.
Eigen::Matrix3d InformationOfVerticals(const SegmentView& view, double sigma,
                                       const Eigen::Vector3d& up_in_world);

// What is made by people has vertical edges. The planes through a camera's centre and the images of
// vertical edges contain the up direction. Each segment counts by its length, in proportion to
// segments of a tenth of the image's height, with this standard deviation (rad) of the angle
// between up and its plane; segments off by more than three are of other edges: their cost is
// bounded. Cameras whose optical axes are closer than about `correlation_rad` see the same edges
// and count together as one. The attitude with these in addition, about the direction of lowest
// cost within `max_tilt` of its own.
CameraAttitude WithVerticals(const CameraAttitude& attitude, const std::vector<SegmentView>& views,
                             double sigma, double correlation_rad, double max_tilt);

}  // namespace soslam
