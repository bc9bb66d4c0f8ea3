// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "geometry/plane.h"
#include "model/sequence.h"
#include "planes/camera_holding.h"

namespace soslam {

struct EstimatedPlane {
  Plane plane_in_world;
  Eigen::Vector3d point_in_world =
      Eigen::Vector3d::Zero();  // on the plane, among what stands on it
  Eigen::Vector3d x_axis_in_world = Eigen::Vector3d::UnitX();  // in the plane
  // Of the plane's turns (rad) about x_axis_in_world and normal x x_axis_in_world through the
  // point, and of its rise (m) along the normal; none where it is not known.
  std::optional<Eigen::Matrix3d> covariance;
};

// Why an object is mounted on the plane that it is.
enum class SupportReason {
  kOwnHeight,     // its views determine the height of its lowest point
  kLowestCost,    // they do not: the plane on which its boxes are explained best
  kNoViews,       // it has none: the plane of most objects
  kCameraHeight,  // the ground below the cameras that see it
  kNoBody,        // its boxes are of a body on none of the planes: the plane of most objects
  kMoving,        // it is in no one place: the plane of most objects
  kNone,          // no plane that it could be mounted on was found: its boxes cannot be used
};
inline constexpr std::array kSupportReasonNames = {
    "own_height", "lowest_cost", "no_views", "camera_height", "no_body", "moving", "none"};

struct ObjectSupport {
  int plane_index = 0;
  SupportReason reason = SupportReason::kNoViews;
  // Of its lowest point over the plane (m), by its own views, the normal being known.
  std::optional<double> height;
  std::optional<double> height_sigma;
  std::optional<double> cost;  // of its boxes, on its plane
};

// One way in which the cameras may be held, and what came of it.
struct TriedHolding {
  CameraHolding holding = CameraHolding::kLevel;
  bool verticals = false;  // taken to be in the images
  double cost = 0.0;       // over the lowest of all (negative logarithms of likelihoods)
  double probability = 0.0;
  std::optional<int> planes;  // how many; none when it was given up before
};

struct PlanesEstimate {
  std::vector<EstimatedPlane> planes;
  std::vector<ObjectSupport> objects;  // of the sequence's
  // What is known of up in the world before boxes are looked at: the best direction, and half
  // u^T information u, the cost of a unit vector u (1 / rad^2).
  Eigen::Vector3d up_of_cameras = Eigen::Vector3d::UnitZ();
  std::optional<Eigen::Matrix3d> attitude_information;
  // Empty where the cameras' attitude was given; otherwise in the order of kCameraHoldings, and
  // what is taken.
  std::vector<TriedHolding> holdings;
  CameraHolding holding = CameraHolding::kLevel;
  bool verticals = false;
  // Of the normals, as the cameras may be held otherwise (rad^2); zero where that is clear.
  double holding_tilt_variance = 0.0;
  std::optional<double> cost;  // of all boxes, ratios and camera attitudes
  double expected_cost = 0.0;  // of the boxes' noise alone
  int rounds = 0;              // of deciding who stands where
  bool settled = false;        // the last round decided as the one before
};

// The sequence with these planes, carried into each frame with the estimated pose. Detections of
// objects without any are left out, and counted as rejected.
Sequence WithPlanes(Sequence sequence, const PlanesEstimate& estimate);

// How far an estimated plane is from the one that the sequence gives most of the objects on it, for
// evaluation; none when no object stands on it.
struct PlaneError {
  int given_plane_index = 0;
  double angle = 0.0;   // between the normals (rad)
  double offset = 0.0;  // of the estimated plane's point over the given plane (m)
};
std::optional<PlaneError> CompareWithGiven(const Sequence& given, const PlanesEstimate& estimate,
                                           int plane_index);

}  // namespace soslam
