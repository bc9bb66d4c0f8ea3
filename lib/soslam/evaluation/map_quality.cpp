// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "soslam/base/assignment.h"
#include "soslam/evaluation/map_reasons.h"
#include "soslam/evaluation/metrics.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/model/label_groups.h"

namespace soslam {
namespace {

using Fate = LandmarkFate;

// Compares a landmark with a true object in the frames of its observations, if the true object's
// place there is known.
std::optional<InFrames> CompareInFrames(const ReasonInput& input, const TrueViews& views,
                                        const std::vector<int>& detections,
                                        const AlignedLandmark& landmark, int true_index) {
  std::vector<LandmarkErrors> errors;
  for (const int index : detections) {
    const int frame = input.sequence.detections[index].frame_index;
    const auto truth_in_camera = views.KnownInCamera(frame, true_index);
    if (!truth_in_camera) continue;
    errors.push_back(CompareInCamera(
        Transform(input.map.world_from_camera[frame].Inverse(), landmark.landmark_in_world),
        input.sequence.true_objects[true_index].truth, *truth_in_camera));
  }
  if (errors.empty()) return std::nullopt;
  return InFrames{static_cast<int>(errors.size()),
                  *MeanOf(CollectValues(errors, &LandmarkErrors::iou)),
                  *MeanOf(CollectValues(errors, &LandmarkErrors::centre_m)),
                  *MeanWhatIf(errors, &LandmarkErrors::what_if)};
}

// The row of a landmark: found if `input` matches it; else ignored if it is at the place of ignored
// things and the reason why it is false names no wanted object; else false, with that reason.
// `detections` are those of the landmark's object.
LandmarkRow MakeRow(const ReasonInput& input, const TrueViews& views,
                    const std::vector<int>& detections, size_t landmark_index) {
  const Sequence& sequence = input.sequence;
  const AlignedLandmark& landmark = input.map.landmarks[landmark_index];
  const std::string& label = sequence.objects[landmark.object_index].label;
  LandmarkRow row;
  row.object_index = landmark.object_index;
  // The mean score, times the share of the segment's frames that the detections are in: there is at
  // most one in a frame.
  double sum = 0.0;
  for (const int index : detections) sum += sequence.detections[index].score;
  row.score = sum / static_cast<double>(
                        std::ranges::count(sequence.frames, landmark.segment, &Frame::segment));
  if (const int truth = input.truth_of_landmark[landmark_index]; truth != kUnassigned) {
    row.fate = Fate::kFound;
    row.true_index = truth;
    int known = 0, agreeing = 0;
    for (const int index : detections) {
      const auto& id = sequence.detections[index].true_object_id;
      known += id ? 1 : 0;
      agreeing += id == sequence.true_objects[truth].id ? 1 : 0;
    }
    if (known > 0) row.id_agrees = 2 * agreeing > known;
  } else {
    const Explanation why = ExplainFalse(input, static_cast<int>(landmark_index));
    const bool is_of_wanted = why.true_object && sequence.true_objects[*why.true_object].IsWanted();
    if (!is_of_wanted && IsIgnored(sequence, label, landmark)) {
      row.fate = Fate::kIgnored;
      return row;
    }
    row.why_false = why;
    row.true_index = why.true_object;
    if (!is_of_wanted) return row;
  }
  const TrueObject& object = sequence.true_objects[*row.true_index];
  const Landmark& truth_in_world = object.truth.landmark_in_world;
  row.errors = CompareBodies(landmark.landmark_in_world, object.truth, truth_in_world);
  row.label_agrees = AreSameLabel(label, object.label);
  if (row.label_agrees) {
    const auto estimate =
        std::ranges::find(input.estimates, landmark.object_index, &ObjectEstimate::object_index);
    row.front = CompareFronts(*estimate, landmark.landmark_in_world, object.truth);
  }
  if (landmark.plane_in_world) row.plane = ComparePlane(*landmark.plane_in_world, truth_in_world);
  if (!row.why_false || IsWrong(row.why_false->reason)) {
    row.in_frames = CompareInFrames(input, views, detections, landmark, *row.true_index);
  }
  return row;
}

std::vector<TrueObjectRow> ObjectRows(const Sequence& sequence, const AlignedMap& map,
                                      const ViewsOfTruth& views,
                                      const std::vector<int>& truth_of_landmark) {
  std::vector<TrueObjectRow> rows;
  for (size_t i = 0; i < sequence.true_objects.size(); ++i) {
    if (!sequence.true_objects[i].IsWanted()) continue;
    TrueObjectRow row{static_cast<int>(i), views.detected_frames[i],
                      views.detected_frames[i] >= kFewestViews};
    const auto landmark = std::ranges::find(truth_of_landmark, row.true_index);
    if (landmark != truth_of_landmark.end()) {
      row.object_index = map.landmarks[landmark - truth_of_landmark.begin()].object_index;
    }
    rows.push_back(row);
  }
  return rows;
}

FoundSummary Summarise(std::vector<LandmarkRow> rows) {
  std::erase_if(rows, [](const LandmarkRow& row) { return row.fate != Fate::kFound; });
  const auto mean = [&](const auto& of_errors) {
    return MeanOf(CollectValues(
        rows, [&](const LandmarkRow& row) { return std::invoke(of_errors, *row.errors); }));
  };
  const auto plane_mean = [&](const auto& of_errors) {
    return MeanOf(CollectValues(rows, [&](const LandmarkRow& row) {
      return row.plane ? std::optional(of_errors(*row.plane)) : std::nullopt;
    }));
  };
  FoundSummary summary;
  summary.iou_mean = mean(&BodyErrors::iou);
  summary.centre_m_mean = mean(&BodyErrors::centre_m);
  summary.centre_relative_mean = mean(&BodyErrors::centre_relative);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<size_t>(axis);
    summary.log_size_mean[i] = mean([&](const BodyErrors& e) { return e.log_size[axis]; });
    summary.log_size_abs_mean[i] =
        mean([&](const BodyErrors& e) { return std::abs(e.log_size[axis]); });
  }
  summary.log_scale_mean = mean(&BodyErrors::log_scale);
  summary.log_scale_abs_mean = mean([](const BodyErrors& e) { return std::abs(e.log_scale); });
  summary.yaw_error_deg_mean = mean(&BodyErrors::yaw_deg);
  summary.up_error_deg_mean = mean(&BodyErrors::up_deg);
  summary.plane_offset_m_abs_mean =
      plane_mean([](const PlaneErrors& plane) { return std::abs(plane.offset_m); });
  summary.plane_tilt_deg_mean = plane_mean([](const PlaneErrors& plane) { return plane.tilt_deg; });
  std::vector<FrontError> fronts;
  for (const LandmarkRow& row : rows) {
    fronts.push_back(row.front);
    summary.quarter_turned += row.errors->is_quarter_turned ? 1 : 0;
    summary.labels_agree += row.label_agrees ? 1 : 0;
    summary.ids_known += row.id_agrees ? 1 : 0;
    summary.ids_agree += row.id_agrees.value_or(false) ? 1 : 0;
  }
  summary.fronts = SummariseFronts(fronts);
  return summary;
}

std::optional<double> Share(int part, int whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / whole;
}

// The area under the envelope of the precision over the recall, as landmarks are taken by
// descending score, those of one score at once. None without true objects.
std::optional<double> AveragePrecision(int true_objects, std::vector<LandmarkRow> landmarks) {
  std::erase_if(landmarks, [](const LandmarkRow& row) { return row.fate == Fate::kIgnored; });
  std::ranges::sort(landmarks, std::greater<>(), &LandmarkRow::score);
  double precision = 0.0, area = 0.0;  // of the envelope, from the last landmark to the first
  auto right = std::ranges::count(landmarks, Fate::kFound, &LandmarkRow::fate);
  for (size_t i = landmarks.size(); i-- > 0;) {
    const bool ends_score =
        i + 1 == landmarks.size() || landmarks[i + 1].score < landmarks[i].score;
    if (ends_score) {
      precision = std::max(precision, static_cast<double>(right) / static_cast<double>(i + 1));
    }
    if (landmarks[i].fate != Fate::kFound) continue;
    area += precision;
    --right;
  }
  if (true_objects == 0) return std::nullopt;
  return area / true_objects;
}

MapScore Score(double min_iou, const std::vector<TrueObjectRow>& objects,
               const std::vector<LandmarkRow>& landmarks) {
  MapScore score;
  score.min_iou = min_iou;
  score.true_objects = static_cast<int>(objects.size());
  score.landmarks = static_cast<int>(landmarks.size());
  for (const TrueObjectRow& object : objects) {
    score.detectable += object.is_detectable ? 1 : 0;
    score.found += object.object_index ? 1 : 0;
    score.found_detectable += object.object_index && object.is_detectable ? 1 : 0;
  }
  for (const LandmarkRow& landmark : landmarks) {
    score.ignored += landmark.fate == Fate::kIgnored ? 1 : 0;
  }
  const int judged = score.landmarks - score.ignored;
  score.precision = Share(score.found, judged);
  score.recall = Share(score.found, score.true_objects);
  score.f1 = Share(2 * score.found, judged + score.true_objects);
  score.average_precision = AveragePrecision(score.true_objects, landmarks);
  score.recall_of_detectable = Share(score.found_detectable, score.detectable);
  const int judged_of_detectable = judged - (score.found - score.found_detectable);
  score.f1_of_detectable =
      Share(2 * score.found_detectable, judged_of_detectable + score.detectable);
  score.of_found = Summarise(landmarks);
  return score;
}

}  // namespace

std::optional<MapQuality> EvaluateMapQuality(const Sequence& sequence,
                                             const std::vector<ObjectEstimate>& estimates,
                                             const std::vector<Rigid3d>& world_from_camera,
                                             const std::vector<Plane>& planes_in_world,
                                             AlignmentKind alignment) {
  const bool has_truth = std::ranges::any_of(sequence.true_objects, &TrueObject::IsWanted);
  if (!has_truth) return std::nullopt;
  MapQuality quality;
  quality.alignments = AlignSegments(sequence, world_from_camera, alignment);
  const AlignedMap map =
      ApplyAlignments(sequence, estimates, world_from_camera, planes_in_world, quality.alignments);
  const TrueViews true_views(sequence);
  const auto detections = DetectionsByObject(sequence);
  const ViewsOfTruth views = FindViews(sequence, true_views);
  const Eigen::MatrixXd ious = WorldIous(sequence, map);
  for (size_t i = kMapIous.size(); i-- > 0;) {  // the first threshold last, as it defines the rows
    const std::vector<int> truth_of_landmark = MatchByIou(ious, kMapIous[i]);
    const ReasonInput input{sequence, estimates, map, views, ious, truth_of_landmark, kMapIous[i]};
    quality.objects = ObjectRows(sequence, map, views, truth_of_landmark);
    quality.landmarks.clear();
    for (size_t k = 0; k < map.landmarks.size(); ++k) {
      const std::vector<int>& own = detections[map.landmarks[k].object_index];
      quality.landmarks.push_back(MakeRow(input, true_views, own, k));
    }
    quality.scores[i] = Score(kMapIous[i], quality.objects, quality.landmarks);
    if (i > 0) continue;
    for (TrueObjectRow& object : quality.objects) {
      if (object.object_index) continue;
      object.miss = ExplainMiss(input, object.true_index);
      ++quality.misses[object.miss->reason];
    }
    for (const LandmarkRow& row : quality.landmarks) {
      if (row.why_false) ++quality.false_landmarks[row.why_false->reason];
    }
  }
  std::vector<InFrames> in_frames;
  std::vector<BodyErrors> in_world;
  for (const LandmarkRow& row : quality.landmarks) {
    if (!row.in_frames) continue;
    in_frames.push_back(*row.in_frames);
    in_world.push_back(*row.errors);
  }
  quality.in_frames = {static_cast<int>(in_frames.size()),
                       MeanOf(CollectValues(in_frames, &InFrames::iou_mean)),
                       MeanOf(CollectValues(in_world, &BodyErrors::iou)),
                       MedianOf(CollectValues(in_frames, &InFrames::centre_m_mean)),
                       MedianOf(CollectValues(in_world, &BodyErrors::centre_m)),
                       MeanWhatIf(in_frames, &InFrames::what_if)};
  return quality;
}

}  // namespace soslam
