// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"
#include "soslam/image/edge_maps.h"
#include "soslam/initialisation/cuboid_options.h"
#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Cuboids that stand on a given plane and fill a given box: the proposals of CubeSLAM (Yang and
// Scherer, T-RO 2019, section III-A). At a known yaw the box leaves one degree of freedom: the
// column within the box of the top corner farthest along the view, which is the horizontal part of
// the ray of the box's centre. This corner is the paper's p1, on the upper edge of the box, where
// the camera is above the top and the box near the optical axis.
struct CuboidView {
  Camera camera;
  Box box;
  Plane plane_in_camera;
};

// The yaw (rad) of an object whose x axis points towards the camera.
double YawFacingCamera(const CuboidView& view);

// The cuboid at a yaw (rad, see Yaw) whose top corner farthest along the view has this image column
// (px); of two that are equally far, the one at -x, -y. All four edges of the box touch it. None if
// there is no such cuboid in front of the camera, and where this corner touches the left or right
// edge of the box, which occurs where the camera is rolled.
//
// The paper constructs the image corners one by one, as intersections of box edges and of lines
// through the vanishing points of the three axes, in three configurations (three, two or one
// visible faces), and back-projects them to the plane. The same in space: an edge along an axis is
// in the image on a line through that axis' vanishing point, and which corner touches an edge of
// the box follows from the yaw alone. So the cuboid is the solution of five linear equations in
// place and size, in metres, whatever faces are visible.
std::optional<Landmark> CuboidAt(const CuboidView& view, double yaw, double corner_column_px);

struct CuboidProposal {
  double yaw;  // rad
  Landmark landmark_in_camera;
};

// The proposals for `yaw_samples` yaws, evenly spread over the quarter turn around
// YawFacingCamera, and `corner_samples` columns of the corner, evenly spread within the box.
std::vector<CuboidProposal> ProposeCuboids(const CuboidView& view, int yaw_samples,
                                           int corner_samples);

// Edges of one image that support cuboids in one box.
struct CuboidEvidence {
  cv::Mat distance;                   // EdgeMaps::distance; finite
  std::vector<LineSegment> segments;  // long ones in the box
};
CuboidEvidence EvidenceInBox(const EdgeMaps& maps, const Box& box, double min_segment_fraction);

// Errors of one proposal (section III-C of the paper).
struct CuboidErrors {
  // Mean distance of the visible edges from image edges, as a fraction of the box's diagonal. The
  // mean and not the sum: proposals with few visible edges have no advantage.
  double distance;
  // Sum over the three axes, each with two differences: between the angles of the outmost line
  // segments and of the outmost visible edges that run to its vanishing point, rad.
  double angle;
  double shape;  // excess of the ratio of the footprint's sides over shape_threshold
};
CuboidErrors ComputeErrors(const CuboidView& view, const Landmark& cuboid,
                           const CuboidEvidence& evidence, const CuboidOptions& options);

// The cost of each proposal: distance + w1 angle + w2 shape, the first two scaled to [0, 1] over
// the proposals.
std::vector<double> CuboidCosts(const std::vector<CuboidErrors>& errors,
                                const CuboidOptions& options);

// The best proposal at each yaw, lowest cost first.
std::vector<Hypothesis> BestCuboids(const CuboidView& view, const CuboidEvidence& evidence,
                                    const CuboidOptions& options);

// CubeSLAM's cuboids of all detections: the best one at each yaw, lowest cost first. `edges_of`
// gives the edge maps of a frame, and is called from several threads. Failures:
// frame_without_image, no_edges, no_solution.
LandmarkEstimates InitialiseCuboids(const Sequence& sequence,
                                    const std::function<EdgeMaps(const Frame&)>& edges_of,
                                    const CuboidOptions& options, int threads);

}  // namespace soslam
