// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "soslam/model/metrics.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Description of metrics.json, see base/description.h. Errors of single frames and of whole maps
// are explained in docs/evaluation.md.

template <typename Visitor>
void Describe(Visitor& visit, Alignment& alignment) {
  visit.Field("kind", &alignment.kind, "x -> truth_from_scaled * (scale * x)");
  visit.Field("camera_path", &alignment.path,
              "what the camera centres determine: all (general), not the rotation about their line "
              "(line), neither rotation nor scale (still, unrelated), nothing (few_poses)");
  visit.Field("scale", &alignment.scale, "1 unless kind is similarity", kPositive);
  visit.Field("truth_from_scaled", &alignment.truth_from_scaled, "motion after scaling");
  visit.Field("frames", &alignment.frames, "with an estimated and a true pose", kNotNegative);
  visit.Field("rmse_m", &alignment.rmse_m, "distance of the camera centres, aligned");
  visit.OrAbsent("up_error_deg", &alignment.up_error_deg,
                 "between up of the estimates and of the truth, with the cameras' rotations "
                 "aligned; absent where the world is that of the truth, or either up is unknown");
}

// The alignments of segments, by segment.
struct SegmentAlignment {
  int segment = 0;
  Alignment alignment;
};
template <typename Visitor>
void Describe(Visitor& visit, SegmentAlignment& of) {
  visit.Field("segment", &of.segment, "the segment", kNotNegative);
  Describe(visit, of.alignment);
}

template <typename Visitor>
void Describe(Visitor& visit, WhatIf& what_if) {
  visit.Field("yaw", &what_if.yaw,
              "IoU if turned about its centre to the true yaw of the object or of the body, "
              "whichever fits better; not turned for rotationally symmetric objects");
  visit.Field("quarter_turn", &what_if.quarter_turn,
              "IoU of the best of four quarter turns about its own vertical axis");
  visit.Field("place", &what_if.place, "IoU at the true centre");
  visit.Field("size", &what_if.size,
              "IoU with the true half axes, along the axes that are nearest the true ones");
}

template <typename Visitor>
void Describe(Visitor& visit, FrontError& front) {
  visit.OrAbsent("front_deg", &front.deg,
                 "between the x axes about the true z axis, 0 to 180; absent where the estimate "
                 "has no front_probability, or the truth no front or another label");
  visit.OrAbsent("front_is_known", &front.is_known, "see map.json; absent: false");
}

template <typename Visitor>
void Describe(Visitor& visit, FrontSummary& fronts) {
  visit.Field("objects", &fronts.objects, "that have a front_deg", kAtLeastOne);
  visit.Field("front_deg_mean", &fronts.deg_mean, "over these");
  visit.Field("front_deg_median", &fronts.deg_median, "over these");
  visit.Field("share_below_30_deg", &fronts.share_below_30_deg, "of these", kShare);
  visit.Field("known", &fronts.known, "number of these whose front is known", kNotNegative);
  visit.Field("known_but_wrong", &fronts.known_but_wrong,
              "number of these whose front is known and wrong by more than 45 degrees",
              kNotNegative);
}
inline constexpr const char* kDocOfFronts =
    "front_deg over all that have one; absent where none has";

template <typename Visitor>
void Describe(Visitor& visit, MetricsSummary& summary) {
  visit.Field("objects", &summary.objects, "with ground truth and observations", kNotNegative);
  visit.Field("observations", &summary.observations, "their observations", kNotNegative);
  visit.Field("iou_mean", &summary.iou_mean,
              "intersection over union of the circumscribed boxes, over objects");
  visit.Field("iou_median", &summary.iou_median, "of the same");
  visit.Field("rotation_deg_mean", &summary.rotation_deg_mean,
              "smallest rotation onto any axes of the truth, over objects that have a yaw");
  visit.Field("rotation_deg_median", &summary.rotation_deg_median, "of the same");
  visit.Field("yaw_error_deg_mean", &summary.yaw_error_deg_mean,
              "angle between the x axes about the true z axis, modulo half a turn");
  visit.Field("yaw_error_deg_median", &summary.yaw_error_deg_median, "of the same");
  visit.Field("what_if", &summary.what_if,
              "of single-frame estimates: means as iou_mean; those of maps are in map_quality");
  visit.OrAbsent("fronts", &summary.fronts, kDocOfFronts);
}

template <typename Visitor>
void Describe(Visitor& visit, TrajectoryMetrics& trajectory) {
  visit.Field("ate_rmse_m", &trajectory.ate_rmse_m, "of the estimate, after rigid alignment",
              kNotNegative);
  visit.Field("odometry_ate_rmse_m", &trajectory.odometry_ate_rmse_m, "of the odometry",
              kNotNegative);
}

// The label of a row: that of its object in the sequence or, without one, that which was read.
template <typename Visitor, typename Row, typename Item>
void DescribeLabel(Visitor& visit, Row& row, std::vector<Item> Sequence::*items, int index) {
  const Sequence* sequence = visit.sequence();
  std::string label = sequence == nullptr ? row.label : (sequence->*items).at(index).label;
  visit.Field("label", &label, "category");
  visit.AfterReading([&] { row.label = label; });
}

// Id and label of a row's object.
template <typename Visitor, typename Row>
void DescribeObject(Visitor& visit, Row& row) {
  visit.Id("object", &row.object_index, &Sequence::objects, "id in the sequence");
  DescribeLabel(visit, row, &Sequence::objects, row.object_index);
}

template <typename Visitor>
void Describe(Visitor& visit, ObjectMetrics& metrics) {
  DescribeObject(visit, metrics);
  visit.Field("observations", &metrics.observations, "detections of the object", kNotNegative);
  visit.Field("estimates", &metrics.estimates, "landmarks that were compared", kNotNegative);
  std::optional<double> iou;
  if (metrics.observations > 0) iou = metrics.iou;
  visit.Field("iou", &iou, "0 without estimate, null without observations");
  visit.AfterReading([&] { metrics.iou = iou.value_or(0.0); });
  visit.Field("centre_m", &metrics.centre_m, "distance of the centres");
  visit.Field("rotation_deg", &metrics.rotation_deg,
              "smallest rotation onto any axes of the truth; null for bodies of rotation");
  visit.Field("yaw_error_deg", &metrics.yaw_deg,
              "between the x axes about the true z axis, modulo half a turn");
  visit.OrDefault("attitude_error_deg", &metrics.attitude_deg, {},
                  "smallest rotation of the object's own axes onto the true ones up to half turns");
  Describe(visit, metrics.front);
  visit.Field("what_if", &metrics.what_if,
              "of single-frame estimates: means over the observations, 0 without landmark");
}

template <typename Visitor>
void Describe(Visitor& visit, HeldOutObject& object) {
  DescribeObject(visit, object);
  visit.Field("in_sight", &object.in_sight, "frames with its whole outline", kNotNegative);
  visit.Field("in_sight_matched", &object.in_sight_matched, "matched ones", kNotNegative);
  visit.Field("matched", &object.matched, "in sight or not", kNotNegative);
  visit.Field("iou_mean", &object.iou_mean, "over matched");
}

template <typename Visitor>
void Describe(Visitor& visit, HeldOutMetrics& metrics) {
  double min_iou = kMinHeldOutIou;
  visit.Field("frames", &metrics.frames, "held-out frames", kNotNegative);
  visit.Field("min_iou", &min_iou, "pairs with less do not match");
  visit.Field("detections", &metrics.detections, "in these frames", kNotNegative);
  visit.Field("detections_matched", &metrics.detections_matched, "by a landmark", kNotNegative);
  visit.Field("in_sight", &metrics.in_sight,
              "pairs of a landmark and a frame in which its outline is wholly in the image, as far "
              "from the border as all detections are",
              kNotNegative);
  visit.Field("in_sight_matched", &metrics.in_sight_matched, "by a detection", kNotNegative);
  visit.Field("iou_mean", &metrics.iou_mean, "over matched pairs");
  visit.Field("iou_median", &metrics.iou_median, "over matched pairs");
  visit.Field("iou_mean_of_detections", &metrics.iou_mean_of_detections,
              "over all detections, 0 for those that match no landmark");
  visit.Field("objects", &metrics.objects, "one row per landmark");
}

template <typename Visitor>
void Describe(Visitor& visit, FoundSummary& found) {
  visit.Field("iou_mean", &found.iou_mean, "over the found landmarks, as all that follows");
  visit.Field("centre_m_mean", &found.centre_m_mean, "distance of the centres");
  visit.Field("centre_relative_mean", &found.centre_relative_mean,
              "over the side of a cube with the true volume");
  visit.Field("log_size_mean", &found.log_size_mean,
              "log of estimate over truth along the true x, y, z, with the axes named so that they "
              "are nearest the true ones");
  visit.Field("log_size_abs_mean", &found.log_size_abs_mean, "of absolute values");
  visit.Field("log_scale_mean", &found.log_scale_mean, "of the cube root of the volume");
  visit.Field("log_scale_abs_mean", &found.log_scale_abs_mean, "of absolute values");
  visit.Field("yaw_error_deg_mean", &found.yaw_error_deg_mean,
              "yaw of the body: after naming the axes, so at most some 45 degrees");
  visit.Field("up_error_deg_mean", &found.up_error_deg_mean, "between the z axes");
  visit.Field("plane_offset_m_abs_mean", &found.plane_offset_m_abs_mean,
              "height of the plane that the landmark stands on over the true foot");
  visit.Field("plane_tilt_deg_mean", &found.plane_tilt_deg_mean,
              "between its normal and the true z axis");
  visit.Field("quarter_turned", &found.quarter_turned, "whose x axis is nearest the true y axis",
              kNotNegative);
  visit.Field("labels_agree", &found.labels_agree, "number", kNotNegative);
  visit.Field("ids_known", &found.ids_known, "the dataset says whose boxes they are", kNotNegative);
  visit.Field("ids_agree", &found.ids_agree,
              "most of these boxes are of the object that is matched", kNotNegative);
  visit.OrAbsent("fronts", &found.fronts, kDocOfFronts);
}

template <typename Visitor>
void Describe(Visitor& visit, MapScore& score) {
  visit.Field("min_iou", &score.min_iou,
              "landmarks are matched one to one with true objects, whatever their labels and ids, "
              "from this IoU on");
  visit.Field("true_objects", &score.true_objects,
              "that stand still, with one of the labels that the import was asked for",
              kNotNegative);
  visit.Field("detectable", &score.detectable,
              "with a raw detection (score of at least 0.25, before any gate) in at least three "
              "frames that overlaps the true outline box by at least 0.5",
              kNotNegative);
  visit.Field("landmarks", &score.landmarks, "of the map", kNotNegative);
  visit.Field("ignored", &score.ignored,
              "of things that nobody measured, or whose label was not asked for: neither right nor "
              "wrong",
              kNotNegative);
  visit.Field("found", &score.found, "true objects with a landmark", kNotNegative);
  visit.Field("found_detectable", &score.found_detectable, "of the detectable", kNotNegative);
  visit.Field("precision", &score.precision, "of the landmarks that are not ignored");
  visit.Field("recall", &score.recall, "of all true objects");
  visit.Field("f1", &score.f1, "of all true objects");
  visit.OrDefault("average_precision", &score.average_precision, {},
                  "area under the envelope of the precision over the recall of all true objects, "
                  "as landmarks are taken by descending score");
  visit.Field("recall_of_detectable", &score.recall_of_detectable, "as if there were no others");
  visit.Field("f1_of_detectable", &score.f1_of_detectable, "as if there were no others");
  visit.Field("of_found", &score.of_found, "errors of the found landmarks");
}

template <typename Visitor>
void Describe(Visitor& visit, DriftSummary& drift) {
  visit.Field("landmarks", &drift.landmarks,
              "compared in the frames that saw them: estimated landmark at the estimated pose "
              "against true landmark at the true pose; found ones and those that are wrong in the "
              "world. The gap to the world is the drift",
              kNotNegative);
  visit.Field("iou_mean", &drift.iou_mean, "in frames");
  visit.Field("iou_mean_in_world", &drift.iou_mean_in_world, "of the same landmarks");
  visit.Field("centre_m_median", &drift.centre_m_median, "distance of the centres in frames");
  visit.Field("centre_m_median_in_world", &drift.centre_m_median_in_world, "the same in the world");
  visit.Field("what_if", &drift.what_if, "means over the same landmarks");
}

template <typename Visitor>
void Describe(Visitor& visit, InFrames& in_frames) {
  visit.Field("observations", &in_frames.observations, "number", kAtLeastOne);
  visit.Field("iou_mean", &in_frames.iou_mean, "over these");
  visit.Field("centre_m_mean", &in_frames.centre_m_mean, "distance of the centres");
  visit.Field("what_if", &in_frames.what_if, "means over these");
}

template <typename Visitor>
void Describe(Visitor& visit, BodyErrors& errors) {
  visit.Field("iou", &errors.iou, "in the world");
  visit.Field("centre_m", &errors.centre_m, "distance of the centres");
  visit.Field("centre_relative", &errors.centre_relative,
              "over the side of a cube with the true volume");
  visit.Field("log_size", &errors.log_size, "of estimate over truth, along the true x, y, z");
  visit.Field("log_scale", &errors.log_scale, "of the cube root of the volume");
  visit.Field("yaw_error_deg", &errors.yaw_deg, "of the body; null for bodies of rotation");
  visit.Field("up_error_deg", &errors.up_deg, "between the z axes");
  visit.Field("quarter_turned", &errors.is_quarter_turned, "its x axis is nearest the true y axis");
}

// Adds the reason why a row is missed or false; null where it is neither.
template <typename Visitor>
void DescribeReason(Visitor& visit, std::optional<Explanation>& explanation) {
  std::optional<MapReason> reason;
  std::optional<std::string> detail;
  if (explanation) reason = explanation->reason, detail = explanation->detail;
  visit.Field("reason", &reason, "docs/evaluation.md says what each means");
  visit.Field("detail", &detail, "the same in words, with numbers");
  visit.AfterReading([&] {
    explanation.reset();
    if (reason) explanation = {*reason, detail.value_or("")};
  });
}

template <typename Visitor>
void Describe(Visitor& visit, TrueObjectRow& row) {
  visit.Id("true_object", &row.true_index, &Sequence::true_objects, "id of the true object");
  DescribeLabel(visit, row, &Sequence::true_objects, row.true_index);
  visit.Field("detected_frames", &row.detected_frames, "with a raw detection that overlaps it",
              kNotNegative);
  visit.Field("detectable", &row.is_detectable, "enough of these");
  visit.Id("object", &row.object_index, &Sequence::objects,
           "object of the sequence whose landmark matches; null for a miss");
  DescribeReason(visit, row.miss);
}

template <typename Visitor>
void Describe(Visitor& visit, LandmarkRow& row) {
  DescribeObject(visit, row);
  visit.Field("fate", &row.fate, "found: right; ignored: neither right nor wrong");
  visit.OrAbsent("score", &row.score,
                 "mean score of its detections, times the share of the segment's frames that they "
                 "are in; absent: 0",
                 kNotNegative);
  visit.Id("true_object", &row.true_index, &Sequence::true_objects,
           "what it matches; of a false one what its reason is about");
  visit.Field("errors", &row.errors, "against that object");
  std::optional<double> offset_m, tilt_deg;
  if (row.plane) offset_m = row.plane->offset_m, tilt_deg = row.plane->tilt_deg;
  visit.Field("plane_offset_m", &offset_m,
              "height of the plane that the landmark stands on over the true foot");
  visit.Field("plane_tilt_deg", &tilt_deg, "between that plane and the true one");
  visit.AfterReading([&] {
    if (offset_m && tilt_deg) row.plane = {*offset_m, *tilt_deg};
  });
  std::optional<bool> label_agrees;
  if (row.errors) label_agrees = row.label_agrees;
  visit.Field("label_agrees", &label_agrees, "null where nothing is compared");
  visit.AfterReading([&] { row.label_agrees = label_agrees.value_or(false); });
  Describe(visit, row.front);
  visit.Field("id_agrees", &row.id_agrees, "by most of its boxes; null if they have no ids");
  visit.Field("in_frames", &row.in_frames, "over its observations, in the frame of each camera");
  DescribeReason(visit, row.why_false);
}

template <typename Visitor>
void Describe(Visitor& visit, MapQuality& quality) {
  std::vector<SegmentAlignment> alignments;
  for (const auto& [segment, alignment] : quality.alignments.of_segment) {
    alignments.push_back({segment, alignment});
  }
  visit.Field("alignments", &alignments, "how estimates are moved onto the truth, by segment");
  visit.AfterReading([&] {
    for (const auto& [segment, alignment] : alignments) {
      quality.alignments.of_segment[segment] = alignment;
    }
  });
  visit.Field("scores", &quality.scores,
              "by min_iou; objects, landmarks and reasons are of the first");
  visit.Field("in_frames", &quality.in_frames, "errors without drift");
  visit.Field("objects", &quality.objects, "true objects that stand still");
  visit.Field("landmarks", &quality.landmarks, "landmarks of the map");
  visit.Field("misses", &quality.misses, "true objects without a landmark, by reason",
              kNotNegative);
  visit.Field("false_landmarks", &quality.false_landmarks, "by reason", kNotNegative);
}

template <typename Visitor>
void Describe(Visitor& visit, Metrics& metrics) {
  const Sequence* sequence = visit.sequence();
  std::string dataset = sequence == nullptr ? metrics.dataset : sequence->name;
  std::string odometry_source =
      sequence == nullptr ? metrics.odometry_source : sequence->odometry_source;
  visit.Field("dataset", &dataset, "name of the dataset");
  visit.OrAbsent("odometry_source", &odometry_source,
                 "whose the pose estimates are, such as ORB-SLAM2; absent: unknown");
  visit.AfterReading([&] { metrics.dataset = dataset, metrics.odometry_source = odometry_source; });
  visit.Field("summary", &metrics.summary, "per object over its observations, then over objects");
  visit.Field("first_observation", &metrics.first_observation,
              "of single-frame estimates: the same over the first observation of each object");
  visit.Field("objects", &metrics.objects, "one row per object with ground truth");
  visit.Field("trajectory", &metrics.trajectory,
              "of maps with known true poses: absolute trajectory errors");
  visit.OrAbsent("held_out", &metrics.held_out,
                 "landmarks against detections in frames that they were not estimated from: boxes "
                 "of outlines and detections of equal labels, matched one to one by the largest "
                 "sum of intersections over unions");
  visit.OrAbsent(
      "map_quality", &metrics.map_quality,
      "the map against all true objects that stand still, whoever says which detections "
      "are of which object; absent for single-frame estimates, and without true objects");
}

}  // namespace soslam
