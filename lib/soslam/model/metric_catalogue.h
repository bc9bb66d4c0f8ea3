// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "soslam/base/table.h"
#include "soslam/model/estimates.h"
#include "soslam/model/metrics.h"

namespace soslam {

// The catalogue of metrics: how tables, pages and inspections name and print the numbers of
// metrics.json and map.json, and how they are got from them.

using MetricValues = std::vector<std::optional<double>>;

struct Metric {
  const char* name;       // in names of columns, fields and files: "rotation"
  const char* title;      // for people: "Rot"
  const char* unit = "";  // "deg", "m"; empty without one
  int decimals = 3;
  bool more_is_better = false;

  std::string Key() const;     // name with unit, "rotation_deg"
  std::string Header() const;  // title with unit, "Rot deg"
  bool IsBetter(double value, double other) const;
  // "7.10"; `none` where there is no value. Several values are divided by commas.
  std::string Text(const std::optional<double>& value, const char* none = kNoValue) const;
  std::string Text(const MetricValues& values, const char* none = kNoValue) const;
};

// A metric of a part of what was read. It has one value, or one for each axis.
template <typename Part>
struct MetricOf : Metric {
  MetricValues (*of)(const Part&);

  std::string TextOf(const Part& part) const { return Text(of(part)); }
};

// The value of a member, or its values.
template <auto kMember, typename Part>
MetricValues Get(const Part& part) {
  const auto& member = part.*kMember;
  if constexpr (requires { member.size(); }) {
    return MetricValues(member.begin(), member.end());
  } else {
    return {member};
  }
}

// An error of each object, and its mean over objects.
struct ObjectMetric : MetricOf<ObjectMetrics> {
  std::optional<double> MetricsSummary::*mean = nullptr;
};
inline constexpr ObjectMetric kIou = {
    {{"iou", "IoU", "", 3, true},
     [](const ObjectMetrics& object) -> MetricValues {
       return {object.observations > 0 ? std::optional(object.iou) : std::nullopt};
     }},
    &MetricsSummary::iou_mean};
inline constexpr ObjectMetric kCentreError = {
    {{"centre", "centre error", "m", 3}, Get<&ObjectMetrics::centre_m>}};
inline constexpr ObjectMetric kRotation = {
    {{"rotation", "Rot", "deg", 2}, Get<&ObjectMetrics::rotation_deg>},
    &MetricsSummary::rotation_deg_mean};
inline constexpr ObjectMetric kYawError = {
    {{"yaw_error", "yaw error", "deg", 2}, Get<&ObjectMetrics::yaw_deg>},
    &MetricsSummary::yaw_error_deg_mean};
inline constexpr ObjectMetric kFrontError = {
    {{"front", "front error", "deg", 2},
     [](const ObjectMetrics& object) -> MetricValues { return {object.front.deg}; }}};
inline constexpr ObjectMetric kObjectMetrics[] = {kIou, kCentreError, kRotation, kYawError,
                                                  kFrontError};
// The metrics of objects that have a mean.
inline constexpr ObjectMetric kMeanMetrics[] = {kIou, kRotation, kYawError};

// Columns of tables in which there are fronts.
inline constexpr MetricOf<FrontSummary> kFrontMetrics[] = {
    {kFrontError, Get<&FrontSummary::deg_mean>},
    {{"front_median", "median front error", "deg", 2}, Get<&FrontSummary::deg_median>},
    {{"fronts_below_30_deg", "fronts below 30 deg", "", 2, true},
     Get<&FrontSummary::share_below_30_deg>},
    {{"known_fronts", "known fronts", "", 0, true}, Get<&FrontSummary::known>},
    {{"known_but_wrong", "known but wrong", "", 0}, Get<&FrontSummary::known_but_wrong>}};

inline constexpr MetricOf<TrajectoryMetrics> kTrajectoryError = {
    {"ate_rmse", "ATE", "m", 4}, Get<&TrajectoryMetrics::ate_rmse_m>};
inline constexpr MetricOf<HeldOutMetrics> kHeldOutIou = {
    {"held_out_iou", "held-out IoU", "", 3, true}, Get<&HeldOutMetrics::iou_mean>};

// Maps compared with all true objects.
inline constexpr MetricOf<MapScore> kRecallOfDetectable = {
    {"recall_of_detectable", "R det.", "", 2, true}, Get<&MapScore::recall_of_detectable>};
inline constexpr MetricOf<MapScore> kScoreMetrics[] = {
    {{"right", "right", "", 0, true}, Get<&MapScore::found>},
    {{"precision", "P", "", 2, true}, Get<&MapScore::precision>},
    {{"recall", "R", "", 2, true}, Get<&MapScore::recall>},
    {{"f1", "F1", "", 2, true}, Get<&MapScore::f1>},
    {{"average_precision", "AP", "", 2, true}, Get<&MapScore::average_precision>},
    {kIou, [](const MapScore& score) { return Get<&FoundSummary::iou_mean>(score.of_found); }}};

// The world of a map from images alone.
inline constexpr MetricOf<Alignment> kWorldMetrics[] = {
    {{"world_up_error", "up of map", "deg", 1}, Get<&Alignment::up_error_deg>},
    {{"world_scale", "true / map scale", "", 3}, [](const Alignment& alignment) -> MetricValues {
       const bool is_scaled = alignment.kind == AlignmentKind::kSimilarity;
       return {is_scaled ? std::optional(alignment.scale) : std::nullopt};
     }}};

// Means of absolute values over the landmarks that are right.
inline constexpr Metric kCentre = {"centre", "centre", "m", 3};
inline constexpr Metric kLogSize = {"log_size", "log size x, y, z", "", 2};
inline constexpr Metric kYawOfBody = {"yaw_of_body", "yaw of body", "deg", 1};
inline constexpr MetricOf<FoundSummary> kFoundMetrics[] = {
    {kCentre, Get<&FoundSummary::centre_m_mean>},
    {{"centre_relative", "centre / size", "", 2}, Get<&FoundSummary::centre_relative_mean>},
    {kLogSize, Get<&FoundSummary::log_size_abs_mean>},
    {{"log_scale", "log scale", "", 3}, Get<&FoundSummary::log_scale_abs_mean>},
    {kYawOfBody, Get<&FoundSummary::yaw_error_deg_mean>},
    {{"up", "up", "deg", 1}, Get<&FoundSummary::up_error_deg_mean>},
    {{"plane_offset", "plane", "m", 3}, Get<&FoundSummary::plane_offset_m_abs_mean>},
    {{"plane_tilt", "plane", "deg", 1}, Get<&FoundSummary::plane_tilt_deg_mean>}};

inline constexpr MetricOf<DriftSummary> kDriftIou = {{"iou_in_frames", "IoU, frames", "", 3, true},
                                                     Get<&DriftSummary::iou_mean>};
inline constexpr MetricOf<DriftSummary> kDriftMetrics[] = {
    kDriftIou,
    {{"iou_in_world", "IoU, world", "", 3, true}, Get<&DriftSummary::iou_mean_in_world>}};

// Standard deviation of the yaw about the landmark's z axis, degrees; none without covariance.
std::optional<double> YawSigmaDeg(const ObjectEstimate& estimate);

// Metrics that an estimate has without ground truth.
inline constexpr MetricOf<ObjectEstimate> kEstimateMetrics[] = {
    {{"yaw_sigma", "yaw sigma", "deg", 2},
     [](const ObjectEstimate& estimate) { return MetricValues{YawSigmaDeg(estimate)}; }},
    {{"front_probability", "front probability", "", 2}, Get<&ObjectEstimate::front_probability>}};

// One landmark and its true object.
inline constexpr MetricOf<BodyErrors> kBodyIou = {kIou, Get<&BodyErrors::iou>};
inline constexpr MetricOf<BodyErrors> kBodyMetrics[] = {{kCentre, Get<&BodyErrors::centre_m>},
                                                        {kLogSize, Get<&BodyErrors::log_size>},
                                                        {kYawOfBody, Get<&BodyErrors::yaw_deg>}};

// The IoU in the frames of the cameras, and with one thing replaced by the true one.
inline constexpr MetricOf<InFrames> kIouInFrames = {{"iou_in_frames", "IoU in frames", "", 3, true},
                                                    Get<&InFrames::iou_mean>};
inline constexpr MetricOf<WhatIf> kWhatIfMetrics[] = {
    {{"with_true_yaw", "true yaw", "", 3, true}, Get<&WhatIf::yaw>},
    {{"with_quarter_turn", "quarter turn", "", 3, true}, Get<&WhatIf::quarter_turn>},
    {{"with_true_place", "true place", "", 3, true}, Get<&WhatIf::place>},
    {{"with_true_size", "true size", "", 3, true}, Get<&WhatIf::size>}};

}  // namespace soslam
