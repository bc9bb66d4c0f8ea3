// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "soslam/model/describe_sequence.h"
#include "soslam/model/estimates.h"

namespace soslam {

// Descriptions of initial.json, refined.json and map.json, see base/description.h.

template <typename Visitor>
void Describe(Visitor& visit, Hypothesis& hypothesis) {
  visit.Field("landmark", &hypothesis.landmark_in_camera, "pose and size in the camera's frame", {},
              kInCamera);
  visit.Field("cost", &hypothesis.cost, "half the sum of squared weighted residuals, no unit");
}

template <typename Visitor>
void Describe(Visitor& visit, ObservationEstimate& estimate) {
  const Sequence* sequence = visit.sequence();
  Detection detection;
  if (sequence != nullptr && !sequence->detections.empty()) {
    detection = sequence->detections.at(estimate.detection_index);
  }
  visit.Id("frame", &detection.frame_index, &Sequence::frames, "id of the frame");
  visit.Id("object", &detection.object_index, &Sequence::objects, "id of the object");
  visit.Check([&]() -> std::string {
    if (sequence == nullptr) return "";
    const auto ids = [](const Detection& one) {
      return std::pair(one.frame_index, one.object_index);
    };
    const auto found = std::ranges::lower_bound(sequence->detections, ids(detection), {}, ids);
    if (found == sequence->detections.end() || ids(*found) != ids(detection)) {
      return fmt::format("the sequence has no detection of object {} in frame {}",
                         sequence->ObjectOf(detection).id, sequence->FrameOf(detection).id);
    }
    estimate.detection_index = static_cast<int>(found - sequence->detections.begin());
    return "";
  });
  visit.Field("hypotheses", &estimate.hypotheses,
              "landmarks that explain the observation, best first; empty where there is none");
  visit.Field("failure", &estimate.failure,
              "why there is no landmark, or why a later stage left it as it was; else empty");
}

template <typename Visitor>
void Describe(Visitor& visit, PointPosterior& point) {
  visit.Field("point", &point.point, "index in points.h5", kNotNegative);
  visit.Field("distance", &point.distance, "from the surface, metres, positive outside");
  visit.Field("responsibility", &point.responsibility,
              "posterior probability that the point is of the object", kShare);
}

template <typename Visitor>
void Describe(Visitor& visit, ObjectEstimate& estimate) {
  visit.Id("object", &estimate.object_index, &Sequence::objects, "id of the object");
  visit.Field("observations", &estimate.observations, "number of detections used", kNotNegative);
  visit.Field("landmark", &estimate.landmark_in_world,
              "estimate in the world's frame; null where there is none", {}, kInWorld);
  visit.Field("covariance", &estimate.covariance,
              "9 x 9 over (rotation vector in the world frame, rad; centre in the world frame, m; "
              "log half axes); null where it is not known");
  const Sequence* sequence = visit.sequence();
  std::vector<LabelProbability> labels;
  if (sequence != nullptr && estimate.object_index < std::ssize(sequence->objects)) {
    labels = sequence->objects[estimate.object_index].labels;
  }
  visit.OrAbsent("labels", &labels,
                 "categories that it may be of, most probable first, where that is uncertain; for "
                 "readers of this file alone, as stages take them from the sequence");
  visit.OrAbsent("points", &estimate.points,
                 "sparse points that may be of the object, in the order of points.h5");
  visit.OrAbsent("quarter_turn", &estimate.quarter_turn,
                 "probability that the x axis, modulo half a turn, is rather a quarter turn on, by "
                 "the cost of the object alone; absent where costs have the paper's units",
                 kShare);
  visit.OrAbsent("front_probability", &estimate.front_probability,
                 "probability that the front of the object is the direction of its x axis; absent "
                 "where nothing tells, or its label has no front",
                 kShare);
  static const std::string kKnown =
      fmt::format("this probability is at least {}", kKnownFrontProbability);
  std::optional<bool> front_is_known;
  if (estimate.front_probability) front_is_known = estimate.FrontIsKnown();
  visit.OrAbsent("front_is_known", &front_is_known, kKnown.c_str());
  visit.Field("failure", &estimate.failure, "why there is no landmark; else empty");
  visit.Field("proper_ellipsoid", &estimate.proper_ellipsoid,
              "false: the dual quadric that was found is no ellipsoid, and absolute values of its "
              "squared half axes were taken");
}

// Number of observations and objects with a failure, per reason.
std::map<std::string, int> CountFailures(const LandmarkEstimates& estimates);

template <typename Visitor>
void Describe(Visitor& visit, LandmarkEstimates& estimates) {
  visit.Field("observations", &estimates.observations, "estimates from one detection alone");
  visit.Field("objects", &estimates.objects, "estimates from all detections of an object");
  std::map<std::string, int> failures = CountFailures(estimates);
  visit.Field("failures", &failures, "number of observations and objects with a failure, by reason",
              kNotNegative);
}

template <typename Visitor>
void Describe(Visitor& visit, SolverSummary& solver) {
  visit.Field("initial_cost", &solver.initial_cost,
              "before the first iteration of all frames, without texture, edges and points, which "
              "join in when the rest has settled; half the sum of squared weighted residuals");
  visit.Field("final_cost", &solver.final_cost, "after the last iteration");
  visit.Field("box_cost", &solver.box_cost, "part of the boxes in final_cost", kNotNegative);
  visit.Field("expected_box_cost", &solver.expected_box_cost,
              "of boxes that contain only their noise: 1/2 for each edge, times the weight of its "
              "view",
              kNotNegative);
  visit.Field("iterations", &solver.iterations, "of all frames", kNotNegative);
  visit.Field("converged", &solver.converged, "a tolerance was met before the iterations ran out");
  visit.Field("cost_per_iteration", &solver.cost_per_iteration,
              "it rises where texture, edges or points join in");
  visit.Field("residuals", &solver.residuals,
              "number by kind: boxes, pairs of pixels, images with edges, points, constraints",
              kNotNegative);
  visit.Field("gated", &solver.gated, "number of what was left out before the solve, by reason",
              kNotNegative);
  visit.Field("detector_bias_px", &solver.detector_bias_px,
              "how far outwards the left, top, right and bottom edges of all boxes have to move to "
              "fit; 0 where no bias is estimated");
}

// A row of map.json's "trajectory" and "planes", which have one per frame and plane of the
// sequence.
struct FramePose {
  int frame_index = 0;
  double timestamp = 0.0;
  Rigid3d world_from_camera;
};
struct PlaneEstimate {
  int plane_index = 0;
  Plane plane_in_world;
};

template <typename Visitor>
void Describe(Visitor& visit, FramePose& pose) {
  visit.Id("frame", &pose.frame_index, &Sequence::frames, "id of the frame");
  visit.Field("timestamp", &pose.timestamp, "seconds");
  visit.Field("world_from_camera", &pose.world_from_camera, "estimated pose");
}

template <typename Visitor>
void Describe(Visitor& visit, PlaneEstimate& plane) {
  visit.Id("plane", &plane.plane_index, &Sequence::planes, "id of the plane");
  visit.Field("plane_in_world", &plane.plane_in_world, "where it is");
}

// The reason why these rows are not those of a sequence, in words; empty if they are, or it is
// null.
std::string RowsViolation(const std::vector<FramePose>& trajectory,
                          const std::vector<PlaneEstimate>& planes, const Sequence* sequence);

template <typename Visitor>
void Describe(Visitor& visit, MapEstimate& map) {
  const Sequence* sequence = visit.sequence();
  visit.Field("objects", &map.objects, "estimates from all detections of an object");
  std::vector<FramePose> trajectory;
  for (const Rigid3d& pose : map.world_from_camera) {
    const int index = static_cast<int>(trajectory.size());
    trajectory.push_back({index, sequence->frames.at(index).timestamp, pose});
  }
  visit.Field("trajectory", &trajectory, "one pose per frame of the sequence, in its order");
  std::vector<PlaneEstimate> planes;
  for (const Plane& plane : map.planes_in_world) {
    planes.push_back({static_cast<int>(planes.size()), plane});
  }
  visit.Field("planes", &planes,
              "support planes of the sequence, in its order: estimated ones as they came out, "
              "given ones as they were");
  visit.Field("solver", &map.solver, "how the optimisation went");
  std::optional<AppliedEdits> edits;
  if (sequence != nullptr) edits = sequence->edits;
  visit.OrAbsent("edits", &edits,
                 "corrections of the association by hand; for readers of this file alone");
  visit.Check([&] { return RowsViolation(trajectory, planes, sequence); });
  visit.AfterReading([&] {
    map.world_from_camera.clear();
    map.planes_in_world.clear();
    for (const FramePose& pose : trajectory)
      map.world_from_camera.push_back(pose.world_from_camera);
    for (const PlaneEstimate& plane : planes) map.planes_in_world.push_back(plane.plane_in_world);
  });
}

}  // namespace soslam
