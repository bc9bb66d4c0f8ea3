// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "evaluation/alignment.h"
#include "evaluation/landmark_errors.h"
#include "evaluation/map_reasons.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// Comparison of a map with all true objects, independent of the ids of detections.

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
  std::optional<int> landmark = std::nullopt;  // its matching landmark, into AlignedMap::landmarks
  std::optional<Explanation> miss = std::nullopt;  // reason for a missing landmark
};

// A landmark of the map, and its comparison with a true object if there is one.
struct LandmarkRow {
  int object_index = 0;  // into Sequence::objects
  enum class Fate { kFound, kIgnored, kFalse } fate = Fate::kFalse;
  std::optional<int> true_index =
      std::nullopt;  // for found ones; for false ones the most likely one
  std::optional<BodyErrors> errors = std::nullopt;  // against that object
  std::optional<PlaneErrors> plane = std::nullopt;  // if there are planes
  bool label_agrees = false;
  std::optional<bool> id_agrees = std::nullopt;  // by most of its boxes; none if they have no ids
  std::optional<InFrames> in_frames = std::nullopt;
  std::optional<Explanation> why_false = std::nullopt;
};
inline constexpr const char* kLandmarkFateNames[] = {"found", "ignored", "false"};

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

// None without true objects that the map should contain. A map without landmarks misses them all.
// `world_from_camera` and `planes_in_world` as in MapEstimate.
std::optional<MapQuality> EvaluateMapQuality(const Sequence& sequence,
                                             const std::vector<ObjectEstimate>& estimates,
                                             const std::vector<Rigid3d>& world_from_camera,
                                             const std::vector<Plane>& planes_in_world,
                                             AlignmentKind alignment);

}  // namespace soslam
