// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/model/finding.h"

namespace soslam {

// The results of evaluation: the content of metrics.json. Read without the sequence, its indices of
// objects are ids, and rows have the labels of their objects.

// kAuto is a choice of the user; no alignment is of this kind.
enum class AlignmentKind { kAuto, kNone, kRigid, kSimilarity };
inline constexpr std::array kAlignmentKindNames = {"auto", "none", "rigid", "similarity"};
inline constexpr const auto& NamesOf(AlignmentKind) { return kAlignmentKindNames; }

// The part of an alignment that the camera centres of two trajectories determine.
enum class CameraPath {
  kGeneral,    // all of it
  kLine,       // not the rotation about a line, or only within degrees
  kStill,      // neither rotation nor scale: the true camera stands still
  kUnrelated,  // neither: the paths are unlike each other, or the estimated camera stands still
  kFewPoses,   // nothing: there is none, or one
};
inline constexpr std::array kCameraPathNames = {"general", "line", "still", "unrelated",
                                                "few_poses"};
inline constexpr const auto& NamesOf(CameraPath) { return kCameraPathNames; }

// Transformation of estimates to the true world: x -> truth_from_scaled * (scale * x).
struct Alignment {
  AlignmentKind kind = AlignmentKind::kNone;
  CameraPath path = CameraPath::kFewPoses;
  double scale = 1.0;
  Rigid3d truth_from_scaled;
  int frames = 0;  // frames with an estimated and a true pose
  // Root mean square distance of the camera centres, aligned; none without frames.
  std::optional<double> rmse_m = std::nullopt;
  // Angle between up of the estimates' own world and up of the truth, with the cameras' rotations
  // aligned; none where the world is that of the truth, or either up is unknown.
  std::optional<double> up_error_deg = std::nullopt;

  Eigen::Vector3d Apply(const Eigen::Vector3d& point) const {
    return truth_from_scaled * (scale * point);
  }
  Rigid3d Apply(const Rigid3d& world_from_camera) const;
  Landmark Apply(const Landmark& landmark_in_world) const;
  Plane Apply(const Plane& plane_in_world) const;
  // The transformation alone, of the true world to estimates.
  Alignment Inverse() const;
};

// One for each segment, as each has a world of its own, and what is not as asked for.
struct Alignments {
  std::map<int, Alignment> of_segment;
  std::vector<Finding> findings = {};
};

// The IoU of a landmark with one thing of it replaced by the true one. The yaw of rotationally
// symmetric objects has no meaning: nothing is turned then.
struct WhatIf {
  double yaw = 0.0;           // of the object or, if IoU is higher, of the body as in BodyErrors
  double quarter_turn = 0.0;  // the best of four quarter turns about its own vertical axis
  double place = 0.0;         // the centre
  double size = 0.0;          // the half axes, along the axes that are nearest the true ones
};

// Differences between a landmark and the true one as solids: the estimate's axes are renamed to be
// nearest the true ones, so that a body with other names for its axes is the same. Logarithms are
// of estimate over truth.
struct BodyErrors {
  double iou = 0.0;
  double centre_m = 0.0;
  double centre_relative = 0.0;  // centre_m over the side of a cube with the true volume
  Eigen::Vector3d log_size = Eigen::Vector3d::Zero();  // along the true x, y, z
  double log_scale = 0.0;                              // of the cube root of the volume
  double up_deg = 0.0;            // between the z axes as they are named, 180 for upside down
  std::optional<double> yaw_deg;  // between the x axes about the true z; none of a body of rotation
  bool is_quarter_turned = false;  // its own x axis is named y
};

// Error of an estimate that has a front_probability, against a truth that may have a front and has
// the label of the estimate.
struct FrontError {
  std::optional<double> deg;  // between the x axes about the true z axis, 0 to 180
  bool is_known = false;      // ObjectEstimate::FrontIsKnown
};

// Summary over those that have such an error.
struct FrontSummary {
  int objects = 0;
  double deg_mean = 0.0, deg_median = 0.0;
  double share_below_30_deg = 0.0;
  int known = 0;
  int known_but_wrong = 0;  // by more than 45 degrees
};

// Errors of a landmark's support plane against that of the true one.
struct PlaneErrors {
  double offset_m = 0.0;  // height above the true contact point, along the plane's own normal
  double tilt_deg = 0.0;
};

// Thresholds of IoU above which a landmark matches a true object. Rows and reasons are those of the
// first threshold.
inline constexpr std::array kMapIous = {0.25, 0.5};

// Reasons for a true object without landmark, or a landmark without true object.
enum class MapReason {
  kNotDetected,        // boxes overlap it in fewer than kFewestViews frames
  kGated,              // so many boxes, but in use in fewer, and none left out by association
  kLostInAssociation,  // the same, and association left boxes out in other frames
  kSplit,              // boxes are spread over several objects, or another landmark has it already
  kJoined,             // boxes are, or are taken for, those of several true objects
  kNoLandmark,         // the object has boxes enough, and no estimate
  kWrongPlane,         // a landmark of its boxes is elsewhere, for the plane that it stands on
  kWrongHeight,        // or for its height over that
  kWrongSize,
  kWrongYaw,
  kWrongPlace,
  kWrongInSeveral,  // no single correction makes it match
  kDuplicate,       // overlaps a true object that another landmark matches better
  kMoving,          // its boxes belong to a moving object
  kBackground,      // at most half of its boxes belong to true objects that are looked for
};
inline constexpr std::array kMapReasonNames = {
    "not_detected", "gated",       "lost_in_association", "split",
    "joined",       "no_landmark", "wrong_plane",         "wrong_height",
    "wrong_size",   "wrong_yaw",   "wrong_place",         "wrong_in_several",
    "duplicate",    "moving",      "background"};
inline constexpr const auto& NamesOf(MapReason) { return kMapReasonNames; }

struct Explanation {
  MapReason reason = MapReason::kNotDetected;
  std::string detail;                             // with numbers, for a person
  std::optional<int> true_object = std::nullopt;  // for a false landmark: into true_objects
};

// Errors of a landmark in the frames of the cameras that observed it, means over these
// observations: estimated landmark at the estimated pose against true landmark at the true pose, or
// against the dataset's truth of that frame.
struct InFrames {
  int observations = 0;
  double iou_mean = 0.0;
  double centre_m_mean = 0.0;
  WhatIf what_if = {};
};

// A true object that the map should contain: it stands still, and its label is one of those asked
// for.
struct TrueObjectRow {
  int true_index = 0;       // into Sequence::true_objects
  int detected_frames = 0;  // with a raw detection that overlaps it
  bool is_detectable = false;
  std::optional<int> object_index = std::nullopt;  // of its landmark, into Sequence::objects
  std::optional<Explanation> miss = std::nullopt;  // reason for a missing landmark
  std::string label = {};                          // of the object, where the row was read
};

enum class LandmarkFate { kFound, kIgnored, kFalse };
inline constexpr std::array kLandmarkFateNames = {"found", "ignored", "false"};
inline constexpr const auto& NamesOf(LandmarkFate) { return kLandmarkFateNames; }

// A landmark of the map, and its comparison with a true object if there is one.
struct LandmarkRow {
  int object_index = 0;  // into Sequence::objects
  LandmarkFate fate = LandmarkFate::kFalse;
  std::optional<int> true_index =
      std::nullopt;  // for found ones; for false ones the most likely one
  std::optional<BodyErrors> errors = std::nullopt;  // against that object
  std::optional<PlaneErrors> plane = std::nullopt;  // if there are planes
  bool label_agrees = false;
  std::optional<bool> id_agrees = std::nullopt;  // by most of its boxes; none if they have no ids
  std::optional<InFrames> in_frames = std::nullopt;
  std::optional<Explanation> why_false = std::nullopt;
  std::string label = {};  // of the object, where the row was read
  FrontError front = {};
  // Mean score of its detections, times the share of the segment's frames that they are in.
  double score = 0.0;
};

// Summary over the found landmarks for one IoU threshold.
struct FoundSummary {
  std::optional<double> iou_mean, centre_m_mean, centre_relative_mean;
  std::array<std::optional<double>, 3> log_size_mean, log_size_abs_mean;
  std::optional<double> log_scale_mean, log_scale_abs_mean;
  std::optional<double> yaw_error_deg_mean, up_error_deg_mean;
  std::optional<double> plane_offset_m_abs_mean, plane_tilt_deg_mean;
  int quarter_turned = 0;
  int labels_agree = 0;
  int ids_known = 0;
  int ids_agree = 0;
  std::optional<FrontSummary> fronts = {};
};

struct MapScore {
  double min_iou = 0.0;
  int true_objects = 0;
  int detectable = 0;
  int landmarks = 0;  // ignored ones included
  int ignored = 0;
  int found = 0;
  int found_detectable = 0;
  std::optional<double> precision, recall, f1;  // over all true objects
  // Area under the envelope of the precision over the recall, as landmarks are taken by descending
  // score.
  std::optional<double> average_precision = std::nullopt;
  std::optional<double> recall_of_detectable,
      f1_of_detectable;  // undetectable objects count as ignored
  FoundSummary of_found;
};

// Means over the landmarks that are compared in frames: the found ones, and those whose boxes are
// of a true object but that are wrong in the world, as drift makes them.
struct DriftSummary {
  int landmarks = 0;
  std::optional<double> iou_mean, iou_mean_in_world;
  std::optional<double> centre_m_median, centre_m_median_in_world;
  std::optional<WhatIf> what_if = {};
};

struct MapQuality {
  Alignments alignments;
  std::array<MapScore, kMapIous.size()> scores;
  DriftSummary in_frames;
  std::vector<TrueObjectRow> objects;
  std::vector<LandmarkRow> landmarks;  // same order as AlignedMap::landmarks
  std::map<MapReason, int> misses, false_landmarks;
};

// Agreement of landmarks with detections in frames that were not used to estimate them. In each of
// these frames the outline boxes of the landmarks and the detected boxes are matched one to one,
// with equal labels, so that the sum of intersections over unions is maximal; pairs below
// kMinHeldOutIou do not match.
inline constexpr double kMinHeldOutIou = 0.25;

// Results of one landmark over the held-out frames. It is in sight if its outline is wholly in the
// image, as far from the border as all detections are; whether occluded or not.
struct HeldOutObject {
  int object_index = 0;
  int in_sight = 0;
  int in_sight_matched = 0;
  int matched = 0;                 // whether in sight or not
  std::optional<double> iou_mean;  // over `matched`
  std::string label = {};          // of the object, where the row was read
};

struct HeldOutMetrics {
  int frames = 0;
  int detections = 0;
  int detections_matched = 0;
  int in_sight = 0;  // pairs of landmark and frame
  int in_sight_matched = 0;
  std::optional<double> iou_mean, iou_median;    // over matched pairs
  std::optional<double> iou_mean_of_detections;  // 0 for those without a matching landmark
  std::vector<HeldOutObject> objects;            // only objects with a landmark
};

// Metrics of one ground-truth object: means over its observations (single frame), or its landmark's
// errors. An observation or object without estimate has IoU 0 and no angles.
struct ObjectMetrics {
  int object_index = 0;
  int observations = 0;  // detections of the object
  int estimates = 0;     // landmarks that were compared
  double iou = 0.0;
  std::optional<double> centre_m;
  std::optional<double> rotation_deg;
  std::optional<double> yaw_deg;
  std::optional<double> attitude_deg = {};
  std::optional<WhatIf> what_if = {};  // of single-frame estimates only; 0 without estimate
  std::string label = {};              // of the object, where the row was read
  FrontError front = {};               // of landmarks over several frames only
};

// Summary over objects. Angles: over the objects that have them.
struct MetricsSummary {
  int objects = 0;       // with ground truth
  int observations = 0;  // that were compared
  std::optional<double> iou_mean, iou_median;
  std::optional<double> rotation_deg_mean, rotation_deg_median;
  std::optional<double> yaw_error_deg_mean, yaw_error_deg_median;
  std::optional<WhatIf> what_if = {};
  std::optional<FrontSummary> fronts = {};
};

struct TrajectoryMetrics {
  double ate_rmse_m = 0.0;
  double odometry_ate_rmse_m = 0.0;
};

struct Metrics {
  MetricsSummary summary;
  std::vector<ObjectMetrics> objects;
  std::optional<MetricsSummary> first_observation;  // for single-frame estimates only
  std::optional<TrajectoryMetrics> trajectory;      // for maps only, if the true poses are known
  std::optional<HeldOutMetrics> held_out;           // if frames were held out
  std::optional<MapQuality> map_quality;            // for maps only, with true objects
  // Name and odometry of the sequence, where metrics were read.
  std::string dataset = {}, odometry_source = {};
};

}  // namespace soslam
