// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Core>
#include <algorithm>

#include "soslam/base/assignment.h"
#include "soslam/evaluation/map_reasons.h"
#include "soslam/evaluation/metrics.h"
#include "soslam/evaluation/statistics.h"

namespace soslam {
namespace {

// A landmark and the counts of its evaluation.
struct Judged {
  int object_index;
  Landmark landmark_in_world;
  int segment;  // the segment that defines its world
  int in_sight = 0;
  int in_sight_matched = 0;
  std::vector<double> ious = {};
};

// Matches the landmarks to the boxes of one frame and updates their counts.
void Compare(const Sequence& sequence, const HeldOutFrame& held_out,
             const Rigid3d& world_from_camera, double border_px, std::vector<Judged>* judged) {
  const Camera& camera = sequence.CameraOf(held_out.frame);
  const auto rows = static_cast<Eigen::Index>(judged->size());
  const auto columns = static_cast<Eigen::Index>(held_out.boxes.size());
  Eigen::MatrixXd overlaps = Eigen::MatrixXd::Zero(rows, columns);
  std::vector<bool> is_in_sight(judged->size());
  for (size_t i = 0; i < judged->size(); ++i) {
    const Judged& one = (*judged)[i];
    if (one.segment != held_out.frame.segment) continue;
    const auto outline =
        OutlineBox(camera, Transform(world_from_camera.Inverse(), one.landmark_in_world));
    if (!outline) continue;
    is_in_sight[i] = DistanceToBorder(*outline, camera.width, camera.height) >= border_px;
    const std::string& label = sequence.objects[one.object_index].label;
    for (size_t k = 0; k < held_out.boxes.size(); ++k) {
      if (held_out.boxes[k].label != label) continue;
      overlaps(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          BoxOverlap(*outline, held_out.boxes[k].box);
    }
  }
  const std::vector<int> box_of = MatchByIou(overlaps, kMinHeldOutIou);
  for (size_t i = 0; i < judged->size(); ++i) {
    const bool is_matched = box_of[i] != kUnassigned;
    if (is_in_sight[i]) ++(*judged)[i].in_sight;
    if (is_in_sight[i] && is_matched) ++(*judged)[i].in_sight_matched;
    if (is_matched) (*judged)[i].ious.push_back(overlaps(static_cast<Eigen::Index>(i), box_of[i]));
  }
}

}  // namespace

std::optional<HeldOutMetrics> EvaluateHeldOut(const Sequence& sequence,
                                              const std::vector<ObjectEstimate>& estimates,
                                              const std::vector<Rigid3d>& world_from_camera) {
  if (sequence.held_out.empty() || estimates.empty()) return std::nullopt;
  const auto detections = DetectionsByObject(sequence);
  std::vector<Judged> judged;
  for (const ObjectEstimate& estimate : estimates) {
    const std::vector<int>& own = detections[estimate.object_index];
    if (!estimate.landmark_in_world || own.empty()) continue;
    const int segment = sequence.FrameOf(sequence.detections[own.front()]).segment;
    judged.push_back({estimate.object_index, *estimate.landmark_in_world, segment});
  }
  const double border_px = SmallestDistanceToBorder(sequence);
  for (size_t i = 0; i < sequence.held_out.size(); ++i) {
    Compare(sequence, sequence.held_out[i], world_from_camera[i], border_px, &judged);
  }
  HeldOutMetrics metrics;
  metrics.frames = static_cast<int>(sequence.held_out.size());
  for (const HeldOutFrame& held_out : sequence.held_out) {
    metrics.detections += static_cast<int>(held_out.boxes.size());
  }
  std::vector<double> ious;
  for (const Judged& one : judged) {
    const auto matched = static_cast<int>(one.ious.size());
    metrics.detections_matched += matched;
    metrics.in_sight += one.in_sight;
    metrics.in_sight_matched += one.in_sight_matched;
    metrics.objects.push_back(
        {one.object_index, one.in_sight, one.in_sight_matched, matched, MeanOf(one.ious)});
    ious.insert(ious.end(), one.ious.begin(), one.ious.end());
  }
  metrics.iou_mean = MeanOf(ious);
  metrics.iou_median = MedianOf(ious);
  ious.resize(static_cast<size_t>(metrics.detections), 0.0);
  metrics.iou_mean_of_detections = MeanOf(ious);
  return metrics;
}

std::vector<Rigid3d> HeldOutPoses(const Sequence& sequence,
                                  const std::vector<Rigid3d>& world_from_camera) {
  std::vector<Rigid3d> poses;
  for (const HeldOutFrame& held_out : sequence.held_out) {
    const auto next = std::ranges::upper_bound(sequence.frames, held_out.frame.id, {}, &Frame::id);
    const bool has_before =
        next != sequence.frames.begin() && std::prev(next)->segment == held_out.frame.segment;
    const auto known =
        static_cast<size_t>((has_before ? std::prev(next) : next) - sequence.frames.begin());
    poses.push_back(world_from_camera[known] * sequence.frames[known].world_from_camera.Inverse() *
                    held_out.frame.world_from_camera);
  }
  return poses;
}

}  // namespace soslam
