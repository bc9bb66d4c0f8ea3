// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/up_estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <optional>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/initialisation/object_evidence.h"
#include "soslam/planes/camera_orientation.h"

namespace soslam {
namespace {

// Boxes used per label, evenly spread.
constexpr size_t kBoxesOfLabel = 48;
// Threshold of ChooseOrientation, high because level cameras are usual: they are assumed unless
// boxes contradict.
constexpr double kClear = 0.1;
// Orientations that differ in the vertical axis. Its sign does not matter to the fit of a body.
constexpr std::array kOrientations = {CameraOrientation::kLevel, CameraOrientation::kRolled90,
                                      CameraOrientation::kLookingDown,
                                      CameraOrientation::kLookingDownRolled90};

// Standard deviation of the log height of an object whose label has no height.
constexpr double kUnknownHeightLogSigma = 1.0;

// Prior of a label that is not in the table: a cuboid as long and wide as high, with a log standard
// deviation of 1.
const ShapePrior kUnknownShape = {.shape_exponents = kCuboidExponent};

// Poses and detections of one segment.
struct Segment {
  std::vector<Rigid3d> world_from_camera;
  std::map<std::string, std::vector<int>> detections;  // keyed by label
};

// Per label, single-box observations of an upright body at a free height.
using BoxesOfLabels = std::vector<std::vector<ObjectEvidence>>;

UpEstimate EstimateUp(const Segment& segment, const BoxesOfLabels& boxes,
                      const AssociateOptions& options) {
  std::vector<UpPrior> up_priors;
  std::vector<OrientationEvidence> evidence;
  for (const CameraOrientation orientation : kOrientations) {
    const UpPrior up_prior = UpPriorFromCameras(segment.world_from_camera, options.tilt,
                                                options.upright.ViewCorrelation(), orientation);
    const bool is_known = std::ranges::any_of(up_priors, [&](const UpPrior& other) {
      return IsSameUp(other.up_in_world, up_prior.up_in_world);
    });
    if (is_known) continue;
    up_priors.push_back(up_prior);
    OrientationEvidence one{
        .orientation = orientation, .up_in_world = up_prior.up_in_world, .object_costs = {}};
    for (const auto& of_label : boxes) {
      // Mean cost over a label's boxes, because those of the same object are correlated.
      double sum = 0.0;
      int count = 0;
      for (const ObjectEvidence& box : of_label) {
        const auto cost = CostOfUprightBody(one.up_in_world, box);
        if (!cost) continue;
        sum += *cost;
        ++count;
      }
      one.object_costs.push_back(count == 0 ? std::nullopt : std::optional(sum / count));
    }
    evidence.push_back(std::move(one));
  }
  const double expected_cost = 0.5 * static_cast<double>(boxes.size());
  const OrientationChoice choice = ChooseOrientation(evidence, expected_cost, kClear);
  UpEstimate up = MakeUpEstimate(up_priors[choice.best], choice.tilt_variance);
  up.orientation = evidence[choice.best].orientation;
  up.orientation_tilt_variance = choice.tilt_variance;
  for (size_t i = 0; i < evidence.size(); ++i) {
    up.orientations.push_back({.orientation = evidence[i].orientation,
                               .cost = choice.costs[i],
                               .probability = choice.probabilities[i],
                               .planes = {}});
  }
  return up;
}

}  // namespace

UpEstimate MakeUpEstimate(const UpPrior& prior, double other_variance) {
  const Eigen::Matrix3d level = UprightRotation(prior.up_in_world, 0.0).toRotationMatrix();
  Eigen::Matrix2d covariance = TiltCovariance(prior);
  covariance.diagonal().array() += 0.5 * other_variance;
  return {prior.up_in_world, level.leftCols<2>() * covariance * level.leftCols<2>().transpose()};
}

ShapePrior PriorOfLabel(const SemanticTable& table, const std::string& label,
                        const AssociateOptions& options) {
  ShapePrior prior = table.Find(label).value_or(kUnknownShape);
  if (!prior.height_m) prior.height_m = {options.unknown_height_m, kUnknownHeightLogSigma};
  return prior;
}

std::map<int, UpEstimate> UpOfSegments(const Sequence& sequence, const SemanticTable& table,
                                       const AssociateOptions& options) {
  std::map<int, Segment> segments;
  for (const Frame& frame : sequence.frames) {
    segments[frame.segment].world_from_camera.push_back(frame.world_from_camera);
  }
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Detection& detection = sequence.detections[i];
    segments[sequence.FrameOf(detection).segment]
        .detections[sequence.ObjectOf(detection).label]
        .push_back(static_cast<int>(i));
  }
  std::map<int, UpEstimate> up;
  for (const auto& [id, segment] : segments) {
    if (sequence.ground) {
      up[id] = MakeUpEstimate({sequence.ground->up_information, sequence.ground->up_in_world});
      continue;
    }
    BoxesOfLabels boxes;
    for (const auto& [label, detections] : segment.detections) {
      const ShapePrior prior = PriorOfLabel(table, label, options);
      if (prior.mount == Mount::kOnWall || prior.attitude != Attitude::kStanding) continue;
      boxes.emplace_back();
      for (const int detection : SpreadOver(detections, kBoxesOfLabel)) {
        boxes.back().push_back(EvidenceInWorld(sequence, {detection}, prior, options.upright));
        boxes.back().back().height_is_free = true;
        boxes.back().back().size_is_known = true;
      }
    }
    up[id] = EstimateUp(segment, boxes, options);
  }
  return up;
}

}  // namespace soslam
