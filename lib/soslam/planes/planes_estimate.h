// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "soslam/geometry/plane.h"
#include "soslam/model/sequence.h"
#include "soslam/model/world.h"
#include "soslam/planes/camera_orientation.h"

namespace soslam {

struct EstimatedPlane {
  Plane plane_in_world;
  Eigen::Vector3d point_in_world =
      Eigen::Vector3d::Zero();  // on the plane, in the middle of the objects on it
  Eigen::Vector3d x_axis_in_world = Eigen::Vector3d::UnitX();  // unit vector in the plane
  // Covariance of the plane's rotations (rad) about x_axis_in_world and normal x x_axis_in_world
  // through the point, and of its translation (m) along the normal; none where unknown.
  std::optional<Eigen::Matrix3d> covariance;
  std::optional<HeightPrior> height_prior = {};  // of points
};

struct ObjectSupport {
  int plane_index = 0;
  SupportReason reason = SupportReason::kNoViews;
  // Height of its lowest point over the plane (m), from its own views, given the normal.
  std::optional<double> height;
  std::optional<double> height_sigma;
  std::optional<double> cost;  // cost of its boxes, on its plane
};

struct PlanesEstimate {
  std::vector<EstimatedPlane> planes;
  std::vector<ObjectSupport> objects;  // one per Sequence::objects
  // Prior on up in the world from the cameras alone: the best direction, and the information (1 /
  // rad^2), so that a unit vector u costs 0.5 u^T information u.
  Eigen::Vector3d up_of_cameras = Eigen::Vector3d::UnitZ();
  std::optional<Eigen::Matrix3d> attitude_information;
  // Tried orientations in the order of kCameraOrientations, and the chosen one; empty where the
  // cameras' up prior was given.
  std::vector<TriedOrientation> orientations;
  CameraOrientation orientation = CameraOrientation::kLevel;
  bool verticals = false;
  // Variance of the normals (rad^2) over other possible orientations; zero where the choice is
  // clear.
  double orientation_tilt_variance = 0.0;
  std::optional<double> cost;  // total cost of all boxes, ratios and the up prior
  double expected_cost = 0.0;  // cost expected from the boxes' noise alone
  int rounds = 0;              // iterations of assigning objects to planes
  bool settled = false;        // the last iteration did not change the assignment
};

// The sequence with these planes, transformed into each frame with the estimated pose. Detections
// of objects without a plane are removed and counted as rejected.
Sequence WithPlanes(Sequence sequence, const PlanesEstimate& estimate);

// Error of an estimated plane with respect to the given plane of most objects on it, for
// evaluation; none when no object stands on it.
struct PlaneError {
  int given_plane_index = 0;
  double angle = 0.0;   // between the normals (rad)
  double offset = 0.0;  // of the estimated plane's point over the given plane (m)
};
std::optional<PlaneError> CompareWithGiven(const Sequence& given, const PlanesEstimate& estimate,
                                           int plane_index);

// The row of a plane in reports. `tilt_variance` (rad^2) is added to the tilt of the covariance.
PlaneRow MakePlaneRow(const EstimatedPlane& plane, int id, double tilt_variance = 0.0);

// `given`: the sequence that the planes were estimated from, with its given planes.
PlanesReport MakeReport(const PlanesEstimate& estimate, const Sequence& given);

// Ground planes for cameras that a vehicle holds level at a known height (m): y = height in each
// camera's frame. The ground of a long trajectory is not one plane, so each object gets its own:
// the mean of the planes of the cameras that see it (of all cameras when none does).
PlanesEstimate PlanesBelowCameras(const Sequence& sequence, double height_m);

// The ground plane in the camera's frame.
Plane GroundInCamera(double height_m);

}  // namespace soslam
