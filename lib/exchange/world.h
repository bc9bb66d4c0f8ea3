// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "geometry/camera.h"
#include "geometry/rigid3.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// A frame with the pose that is exported.
struct WorldFrame {
  int id = 0;
  double timestamp = 0.0;  // seconds
  std::string image;       // path relative to the dataset folder; empty: there is no image
  Camera camera;
  Rigid3d world_from_camera;
};

// What an evaluation says of a landmark (docs/evaluation.md).
struct LandmarkVerdict {
  std::string fate;                               // found, ignored, false
  std::optional<int> true_object = std::nullopt;  // its id
  std::optional<double> iou = std::nullopt;       // with that
  std::string reason = {};                        // of a false one
};

// An object with what is exported of it; it may have no landmark, see `failure` of the estimate.
struct WorldObject {
  int id = 0;
  std::string label;
  std::optional<int> segment;      // none: in no frame of several segments, and without a landmark
  Eigen::Vector3d support_normal;  // in the world, unit length
  double score = 1.0;              // mean of its detections; 1 without any
  ObjectEstimate estimate;
  std::optional<LandmarkVerdict> verdict = std::nullopt;  // none without an evaluation
};

// What can be shown together: the frames and objects of one segment, see Frame::segment. Objects of
// no known segment are with those of the first.
struct World {
  int segment = 0;
  std::vector<WorldFrame> frames;
  std::vector<WorldObject> objects;
};

// The poses and objects of a map of the sequence, a world for each of its segments.
std::vector<World> WorldsOfMap(const Sequence& sequence, const MapEstimate& map);
// The poses that the sequence has as estimates; no objects.
std::vector<World> WorldsOfOdometry(const Sequence& sequence);
// The ground truth: frames that have true poses, all true objects of their segments. What is known
// of a true shape are its half axes: landmarks are cuboids, with their z axes for support normals.
// Objects that move have none, and the failure "moving".
std::vector<World> WorldsOfTruth(const Sequence& sequence);

// The support normal (in the world) that most objects with a landmark share to about 25 degrees;
// the z axis without objects.
Eigen::Vector3d UpOf(const World& world);

// The yaw (rad) of the object's landmark, which it must have, about its support normal.
double YawOf(const WorldObject& object);

}  // namespace soslam
