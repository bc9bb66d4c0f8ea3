// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "soslam/geometry/camera.h"
#include "soslam/geometry/distortion.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/model/estimates.h"
#include "soslam/model/map_points.h"
#include "soslam/model/sequence.h"

namespace soslam {

// A frame with its exported pose.
struct WorldFrame {
  int id = 0;
  double timestamp = 0.0;  // seconds
  std::string image;       // path relative to the dataset folder; empty without an image
  Camera camera;
  Rigid3d world_from_camera;
};

// Evaluation of a landmark (docs/evaluation.md).
struct LandmarkVerdict {
  std::string fate;                               // found, ignored, false
  std::optional<int> true_object = std::nullopt;  // its id
  std::optional<double> iou = std::nullopt;       // with the true object
  std::string reason = {};                        // for a false landmark
};

// An object with its exported data; without a landmark, `failure` of the estimate has the reason.
struct WorldObject {
  int id = 0;
  std::string label;
  std::optional<int> segment;  // none if unknown: several segments, no detection and no landmark
  Eigen::Vector3d support_normal;  // in the world, unit length
  double score = 1.0;              // mean of its detections; 1 without any
  ObjectEstimate estimate;
  std::optional<LandmarkVerdict> verdict = std::nullopt;  // none without an evaluation
};

// A sparse point with the image points that it was placed by, in frames of its world.
struct WorldPoint {
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();
  double reprojection_error_px = 0.0;  // mean over its observations
  std::vector<PointObservation> observations;
  std::array<int, 3> rgb = {128, 128, 128};  // 0 to 255; grey where no image tells it
};

// Frames and objects of one segment, which can be shown together, see Frame::segment. Objects of
// unknown segment belong to the first.
struct World {
  int segment = 0;
  std::vector<WorldFrame> frames;
  std::vector<WorldObject> objects;
  std::optional<Distortion> image_distortion = std::nullopt;  // Sequence::image_distortion
  std::vector<WorldPoint> points = {};                        // none unless AddPoints adds them
};

// The poses and objects of a map of the sequence, one world per segment.
std::vector<World> WorldsOfMap(const Sequence& sequence, const MapEstimate& map);
// The poses that the sequence has as estimates (odometry); no objects.
std::vector<World> WorldsOfOdometry(const Sequence& sequence);
// The ground truth: frames with true poses, and all true objects of their segments. Only the half
// axes of true shapes are known: landmarks are cuboids, with their z axes as support normals.
// Objects that move have no landmark, and the failure "moving".
std::vector<World> WorldsOfTruth(const Sequence& sequence);

// The support normal (in the world) that most objects with a landmark share to about 25 degrees;
// the z axis if there are no objects.
Eigen::Vector3d EstimateCommonUp(const World& world);

// The folder that holds the images of all worlds, relative to the dataset folder: "rgb", or the
// last one that they share.
std::filesystem::path FolderOfImages(const std::vector<World>& worlds);

// Adds the points to the worlds of the frames that see them, where the poses of these frames place
// their image points: the world that a file of points has may be another one. Left out are points
// that fewer than two frames of a world see, or from nearly one direction.
void AddPoints(const Sequence& sequence, const std::vector<MapPoint>& points,
               std::vector<World>* worlds);

// The yaw (rad) of the object's landmark about its support normal. The object must have a landmark.
double ComputeYaw(const WorldObject& object);

// `quality` is map_quality of the metrics.json that belongs to the map.

// Gives each landmark the verdict of its evaluation.
void AddVerdicts(const nlohmann::json& quality, std::vector<World>* worlds);

// Moves each world to the true one by the alignment of its segment, including covariances.
void AlignWorlds(const nlohmann::json& quality, std::vector<World>* worlds);

}  // namespace soslam
