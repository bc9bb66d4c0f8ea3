// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "soslam/evaluation/result_checks.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/ground/ground_checks.h"
#include "soslam/inspection/doubts.h"
#include "soslam/model/segments.h"
#include "soslam/report/page_parts.h"
#include "soslam/report/plan_view.h"

namespace soslam {

ScaleOfMap ScaleFromWorld(const std::optional<Artefact<WorldReport>>& world,
                          const Sequence& sequence) {
  constexpr const char* kNoUnit =
      "Nothing tells the scale of this map: lengths have no unit, only their proportions count.";
  ScaleOfMap scale;
  const std::string distrust = DistrustOfMap(world ? &world->body : nullptr, sequence);
  const auto add_warning = [&](const std::string& warning) {
    scale.warning += (scale.warning.empty() ? "" : " ") + warning;
  };
  if (!distrust.empty()) add_warning(fmt::format("Do not trust this map: {}.", distrust));
  if (!world) {
    scale.in_metres = IsInMetresWithoutWorld(sequence);
    if (!scale.in_metres) scale.sentence = kNoUnit;
    return scale;
  }
  const std::optional<WorldScale>& found = world->body.scale;
  scale.in_metres = found.has_value();
  scale.sentence = kNoUnit;
  if (found) {
    scale.log_sigma = found->log_sigma;
    scale.sentence = fmt::format("Scale ± {:.0f} % (95 %), from {}.", HalfIntervalPercent(*found),
                                 SourcesInWords(*found));
    const std::string contradictions = ContradictionsInWords(*found);
    if (!contradictions.empty()) {
      add_warning(fmt::format("The scale may be wrong by more than that: {}.", contradictions));
    }
  }
  scale.sentence +=
      fmt::format(" Up ± {:.1f}° (one standard deviation).", world->body.up.sigma_deg);
  const std::string doubt = DoubtOfUp(world->findings);
  scale.up_is_in_doubt = !doubt.empty();
  if (scale.up_is_in_doubt) {
    add_warning(fmt::format("Up may be wrong by more than that: {}.", doubt));
  }
  return scale;
}

std::string SizeInWords(const ObjectEstimate& estimate, const ScaleOfMap& scale) {
  std::string sizes, intervals;
  for (const int axis : {1, 0, 2}) {  // width, depth, height
    const double size = 2.0 * estimate.landmark_in_world->half_axes[axis];
    const double shown = scale.in_metres ? 100.0 * size : size;
    const int decimals = !scale.in_metres ? 2 : shown < 9.95 ? 1 : 0;
    const char* separator = sizes.empty() ? "" : "\u00a0×\u00a0";
    sizes += fmt::format("{}{:.{}f}", separator, shown, decimals);
    if (!estimate.covariance) continue;
    const double variance = (*estimate.covariance)(6 + axis, 6 + axis);
    const double log_sigma = std::sqrt(variance + scale.log_sigma * scale.log_sigma);
    intervals += fmt::format("{}{:.{}f}", separator, shown * HalfInterval95(log_sigma), decimals);
  }
  if (scale.in_metres) sizes += "\u00a0cm";
  return intervals.empty() ? sizes : fmt::format("{} (±\u00a0{})", sizes, intervals);
}

std::string LabelsInWords(const Object& object) {
  constexpr double kLeast = 0.1, kCertain = 0.995;
  std::vector<std::string> labels;
  for (const auto& [label, probability] : object.labels) {
    const bool is_own = label == object.label;
    if (is_own ? probability >= kCertain : probability < kLeast) continue;
    labels.insert(is_own ? labels.begin() : labels.end(),
                  fmt::format("{} {:.0f}\u00a0%", label, 100.0 * probability));
  }
  std::string words = fmt::format("{}", fmt::join(labels, ", or "));
  if (!object.labels.empty() && object.labels.front().label != object.label) {
    words += fmt::format("; detected as {}, but its size is rather that of {}", object.label,
                         object.labels.front().label);
  }
  return words;
}

namespace {

// Height of things that stand on floors but hardly on tables.
constexpr double kStandsOnFloorM = 0.65;

// The plane of an object, and its height.
std::string PlaneInWords(const ObjectEstimate& estimate, const Sequence& sequence,
                         const MapEstimate& map, const ScaleOfMap& scale) {
  const int own = sequence.objects[estimate.object_index].plane_index;
  if (own == kNoPlane) return "support unknown";
  // Recordings of vehicles have a plane for each object, all of one ground.
  constexpr size_t kMaxPlanesOfRoom = 8;
  if (sequence.planes.size() > kMaxPlanesOfRoom &&
      sequence.planes.size() >= sequence.objects.size()) {
    return "on the ground";
  }
  const int segment = SegmentsOfObjects(sequence)[estimate.object_index].value_or(0);
  const Eigen::Vector3d up = UpOfSegment(sequence, segment);
  std::set<int> level;  // planes that carry objects of the segment
  for (const Detection& detection : sequence.detections) {
    const int plane = sequence.ObjectOf(detection).plane_index;
    if (plane == kNoPlane || sequence.FrameOf(detection).segment != segment) continue;
    if (map.planes_in_world[plane].normal.dot(up) > kLevel) level.insert(plane);
  }
  if (!level.contains(own)) return "on a wall or ceiling";
  const auto height_above = [&](int plane) {
    return map.planes_in_world[plane].SignedDistance(estimate.landmark_in_world->Centre());
  };
  const int lowest = *std::ranges::max_element(level, {}, height_above);
  const bool is_floor = scale.in_metres && !scale.up_is_in_doubt &&
                        std::ranges::any_of(map.objects, [&](const ObjectEstimate& other) {
                          return other.landmark_in_world &&
                                 sequence.objects[other.object_index].plane_index == lowest &&
                                 2.0 * other.landmark_in_world->half_axes.z() > kStandsOnFloorM;
                        });
  const std::string name = is_floor           ? "the floor"
                           : level.size() > 1 ? "the lowest plane"
                                              : "the support plane";
  if (lowest == own) return "on " + name;
  double height = height_above(lowest) - height_above(own);
  if (scale.in_metres) height = std::round(100.0 * height) / 100.0;
  return fmt::format("on plane {}, {} above {}", sequence.planes[own].id,
                     LengthInWords(height, scale.in_metres), name);
}

}  // namespace

std::string SupportInWords(const ObjectEstimate& estimate, const Sequence& sequence,
                           const MapEstimate& map, const ScaleOfMap& scale) {
  const RestingFace face = estimate.landmark_in_world->rests_on;
  const std::string lies =
      face == RestingFace::kBottom
          ? ""
          : fmt::format("on its {}, ", kRestingFaceNames[static_cast<size_t>(face)]);
  return lies + PlaneInWords(estimate, sequence, map, scale);
}

}  // namespace soslam
