// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soslam/geometry/camera.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/image/edge_maps.h"
#include "soslam/initialisation/object_evidence.h"
#include "soslam/model/sequence.h"
#include "soslam/planes/camera_orientation.h"
#include "soslam/planes/options.h"

namespace soslam {

// Prior on the up direction from the cameras alone, before boxes are used.
struct UpPrior {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();   // 1 / rad^2
  Eigen::Vector3d up_in_world = Eigen::Vector3d::UnitZ();  // the one of least cost

  // Negative log likelihood of an upward unit vector in the world.
  double Cost(const Eigen::Vector3d& up) const { return 0.5 * up.dot(information * up); }
};

// Derivative of an up direction by turns (rad) about the x and y axes of UprightRotation(up, 0).
Eigen::Matrix<double, 3, 2> UpByTurns(const Eigen::Vector3d& up);

// Covariance of these two turns of a prior's up direction.
Eigen::Matrix2d TiltCovariance(const UpPrior& prior);

// The prior whose up direction has this covariance of these two turns.
UpPrior WithTiltCovariance(const Eigen::Vector3d& up_in_world, const Eigen::Matrix2d& covariance);

// Weight of each camera: cameras whose optical axes are closer than about `correlation_rad` are
// correlated and count together as one; all weights are 1 where it is zero.
std::vector<double> CameraWeights(const std::vector<Rigid3d>& world_from_camera,
                                  double correlation_rad);

// Prior on up from the way people and vehicles hold cameras. Level cameras have nearly level x
// axes, and less exactly level optical axes; for other orientations see AxesOf. At least one pose.
// The sign of up is that of most cameras.
UpPrior UpPriorFromCameras(const std::vector<Rigid3d>& world_from_camera, const CameraTilt& tilt,
                           double correlation_rad,
                           CameraOrientation orientation = CameraOrientation::kLevel);

// Prior on up where some cameras may be turned in any way: their axes have a bounded loss
// (Geman-McClure). Where most are held less evenly than the sigmas say, the information is smaller.
UpPrior RobustUpPriorFromCameras(const std::vector<Rigid3d>& world_from_camera,
                                 const CameraTilt& tilt, double correlation_rad,
                                 CameraOrientation orientation);

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

// Adds vertical edges of man-made structures to the up prior. The plane through a camera's centre
// and the image of a vertical edge contains the up direction. Each segment is weighted by its
// length, relative to a tenth of the image's height; `sigma` (rad) is the standard deviation of the
// angle between up and its plane. The loss is bounded (Geman-McClure), so that segments off by more
// than three standard deviations, which are not vertical, have little influence. Cameras whose
// optical axes are closer than about `correlation_rad` see the same edges and count together as
// one. The result is linearised at the up direction of least cost within `max_tilt` (rad) of the
// up prior's own.
UpPrior WithVerticals(const UpPrior& up_prior, const std::vector<SegmentView>& views, double sigma,
                      double correlation_rad, double max_tilt);

// Directions around the prior's own, which comes first, in steps of `step` (rad): up to 45 degrees
// and 2.5 standard deviations away.
std::vector<Eigen::Vector3d> UpDirections(const UpPrior& prior, double step);

// The directions of lowest cost that are farther apart than `min_angle` (rad), at most `count`,
// lowest cost first.
std::vector<Eigen::Vector3d> LowestApart(const std::vector<Eigen::Vector3d>& directions,
                                         const std::vector<double>& costs, double min_angle,
                                         size_t count);

// Cost of an object for an up direction in which it has no body; worse than any in which it has
// one.
inline constexpr double kCostWithoutBody = 1e4;

// Cost of an object's boxes with the best upright body of free height; none when there is none.
std::optional<double> CostOfUprightBody(const Eigen::Vector3d& up_in_world,
                                        ObjectEvidence observation);

// Local minima of up, among the directions that the cameras allow, in which upright bodies of free
// height fit the boxes best, lowest cost first. There are several minima, because bodies may stand
// on another of their axes. `observations`: per object; none for objects that do not take part.
std::vector<Eigen::Vector3d> SearchUp(
    const UpPrior& up_prior, const std::vector<std::optional<ObjectEvidence>>& observations,
    int threads);

// world_from_camera of each view.
std::vector<Rigid3d> PosesOf(const std::vector<SegmentView>& views);

}  // namespace soslam
