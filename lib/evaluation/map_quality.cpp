// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/map_quality.h"

#include <algorithm>
#include <cmath>

#include "evaluation/map_rows.h"
#include "evaluation/statistics.h"

namespace soslam {
namespace {

using Fate = LandmarkRow::Fate;

std::vector<TrueObjectRow> ObjectRows(const Sequence& sequence, const ViewsOfTruth& views,
                                      const std::vector<int>& truth_of_landmark) {
  std::vector<TrueObjectRow> rows;
  for (size_t i = 0; i < sequence.true_objects.size(); ++i) {
    if (!sequence.true_objects[i].IsWanted()) continue;
    TrueObjectRow row{static_cast<int>(i), views.detected_frames[i],
                      views.detected_frames[i] >= kFewestViews};
    const auto landmark = std::ranges::find(truth_of_landmark, row.true_index);
    if (landmark != truth_of_landmark.end()) {
      row.landmark = static_cast<int>(landmark - truth_of_landmark.begin());
    }
    rows.push_back(row);
  }
  return rows;
}

// Mean over the landmarks that have this value.
template <typename ValueOf>
std::optional<double> MeanOver(const std::vector<LandmarkRow>& rows, const ValueOf& value_of) {
  std::vector<double> values;
  for (const LandmarkRow& row : rows) {
    if (const std::optional<double> value = value_of(row)) values.push_back(*value);
  }
  return MeanOf(values);
}

FoundSummary Summarise(const std::vector<LandmarkRow>& rows) {
  const auto mean = [&](const auto& of_errors) {
    return MeanOver(rows, [&](const LandmarkRow& row) -> std::optional<double> {
      if (row.fate != Fate::kFound) return std::nullopt;
      return of_errors(row.errors.value());
    });
  };
  FoundSummary summary;
  summary.iou_mean = mean([](const BodyErrors& errors) { return errors.iou; });
  summary.centre_m_mean = mean([](const BodyErrors& errors) { return errors.centre_m; });
  summary.centre_relative_mean =
      mean([](const BodyErrors& errors) { return errors.centre_relative; });
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<size_t>(axis);
    summary.log_size_mean[i] = mean([&](const BodyErrors& e) { return e.log_size[axis]; });
    summary.log_size_abs_mean[i] =
        mean([&](const BodyErrors& e) { return std::abs(e.log_size[axis]); });
  }
  summary.log_scale_mean = mean([](const BodyErrors& errors) { return errors.log_scale; });
  summary.log_scale_abs_mean =
      mean([](const BodyErrors& errors) { return std::abs(errors.log_scale); });
  summary.yaw_deg_mean = mean([](const BodyErrors& errors) { return errors.yaw_deg; });
  summary.up_deg_mean = mean([](const BodyErrors& errors) { return errors.up_deg; });
  const auto plane_mean = [&](const auto& of_errors) {
    return MeanOver(rows, [&](const LandmarkRow& row) -> std::optional<double> {
      if (row.fate != Fate::kFound || !row.plane) return std::nullopt;
      return of_errors(*row.plane);
    });
  };
  summary.plane_offset_m_abs_mean =
      plane_mean([](const PlaneErrors& plane) { return std::abs(plane.offset_m); });
  summary.plane_tilt_deg_mean = plane_mean([](const PlaneErrors& plane) { return plane.tilt_deg; });
  for (const LandmarkRow& row : rows) {
    if (row.fate != Fate::kFound) continue;
    summary.quarter_turned += row.errors->is_quarter_turned ? 1 : 0;
    summary.labels_agree += row.label_agrees ? 1 : 0;
    summary.ids_known += row.id_agrees ? 1 : 0;
    summary.ids_agree += row.id_agrees.value_or(false) ? 1 : 0;
  }
  return summary;
}

std::optional<double> Share(int part, int whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / whole;
}

MapScore Score(double min_iou, const std::vector<TrueObjectRow>& objects,
               const std::vector<LandmarkRow>& landmarks) {
  MapScore score;
  score.min_iou = min_iou;
  score.true_objects = static_cast<int>(objects.size());
  score.landmarks = static_cast<int>(landmarks.size());
  for (const TrueObjectRow& object : objects) {
    score.detectable += object.is_detectable ? 1 : 0;
    score.found += object.landmark ? 1 : 0;
    score.found_detectable += object.landmark && object.is_detectable ? 1 : 0;
  }
  for (const LandmarkRow& landmark : landmarks) {
    score.ignored += landmark.fate == Fate::kIgnored ? 1 : 0;
  }
  const int judged = score.landmarks - score.ignored;
  score.precision = Share(score.found, judged);
  score.recall = Share(score.found, score.true_objects);
  score.f1 = Share(2 * score.found, judged + score.true_objects);
  score.recall_of_detectable = Share(score.found_detectable, score.detectable);
  const int judged_of_detectable = judged - (score.found - score.found_detectable);
  score.f1_of_detectable =
      Share(2 * score.found_detectable, judged_of_detectable + score.detectable);
  score.of_found = Summarise(landmarks);
  return score;
}

DriftSummary SummariseInFrames(const std::vector<LandmarkRow>& rows) {
  const auto mean = [&](const auto& value_of) {
    return MeanOver(rows, [&](const LandmarkRow& row) -> std::optional<double> {
      if (!row.in_frames) return std::nullopt;
      return value_of(row);
    });
  };
  DriftSummary summary;
  summary.landmarks = static_cast<int>(std::ranges::count_if(
      rows, [](const LandmarkRow& row) { return row.in_frames.has_value(); }));
  summary.iou_in_frames = mean([](const LandmarkRow& row) { return row.in_frames->iou; });
  summary.iou_in_world = mean([](const LandmarkRow& row) { return row.errors->iou; });
  std::vector<double> in_frames, in_world;
  for (const LandmarkRow& row : rows) {
    if (!row.in_frames) continue;
    in_frames.push_back(row.in_frames->centre_m);
    in_world.push_back(row.errors->centre_m);
  }
  summary.centre_m_in_frames = MedianOf(in_frames);
  summary.centre_m_in_world = MedianOf(in_world);
  return summary;
}

void ExplainMisses(const ReasonInput& input, MapQuality* quality) {
  for (TrueObjectRow& object : quality->objects) {
    if (object.landmark) continue;
    object.miss = ExplainMiss(input, object.true_index);
    ++quality->misses[object.miss->reason];
  }
  for (const LandmarkRow& row : quality->landmarks) {
    if (row.why_false) ++quality->false_landmarks[row.why_false->reason];
  }
}

}  // namespace

std::optional<MapQuality> EvaluateMapQuality(const Sequence& sequence,
                                             const std::vector<ObjectEstimate>& estimates,
                                             const std::vector<Rigid3d>& world_from_camera,
                                             const std::vector<Plane>& planes_in_world,
                                             AlignmentChoice alignment) {
  const bool has_truth = std::ranges::any_of(sequence.true_objects, &TrueObject::IsWanted);
  if (!has_truth) return std::nullopt;
  MapQuality quality;
  quality.alignments = AlignSegments(sequence, world_from_camera, alignment);
  const AlignedMap map =
      ApplyAlignments(sequence, estimates, world_from_camera, planes_in_world, quality.alignments);
  const TrueViews true_views(sequence);
  const RowMaker maker(sequence, map, true_views);
  const ViewsOfTruth views = FindViews(sequence, true_views);
  const Eigen::MatrixXd ious = WorldIous(sequence, map);
  for (size_t i = kMapIous.size(); i-- > 0;) {  // the first threshold last, as it defines the rows
    const std::vector<int> truth_of_landmark = MatchByIou(ious, kMapIous[i]);
    const ReasonInput input{sequence, estimates, map, views, ious, truth_of_landmark, kMapIous[i]};
    quality.objects = ObjectRows(sequence, views, truth_of_landmark);
    quality.landmarks = maker.Rows(input);
    quality.scores[i] = Score(kMapIous[i], quality.objects, quality.landmarks);
    if (i == 0) ExplainMisses(input, &quality);
  }
  quality.in_frames = SummariseInFrames(quality.landmarks);
  return quality;
}

}  // namespace soslam
