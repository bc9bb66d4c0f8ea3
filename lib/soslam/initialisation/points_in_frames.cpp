// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/points_in_frames.h"

#include <memory>

namespace soslam {

FurtherEvidence InCamera(const PointEvidence& points) {
  const auto cost_at = [points](const Landmark& in_camera) {
    return std::make_unique<PointCost>(points.points, in_camera, points.size_m, points.options,
                                       points.weight);
  };
  return {cost_at, Rigid3d()};
}

double PointWeight(const PointsOfObject& points, const PointOptions& options) {
  double expected = 0.0;
  for (const PointsInView& view : points) {
    for (const ObjectPoint& point : view.points) expected += point.prior;
  }
  return expected > options.effective_points ? options.effective_points / expected : 1.0;
}

PointsInFrames::PointsInFrames(const Sequence& sequence, const std::vector<MapPoint>& points,
                               const PointOptions& options)
    : sequence_(sequence),
      options_(options),
      points_(FindObjectPoints(sequence, points, options)) {}

std::optional<PointEvidence> PointsInFrames::Of(int detection_index,
                                                const std::vector<Hypothesis>& hypotheses) const {
  const Detection& detection = sequence_.detections[detection_index];
  if (hypotheses.empty() || !sequence_.ObjectOf(detection).is_static) return std::nullopt;
  const Frame& frame = sequence_.FrameOf(detection);
  PointsInView in_frame{detection_index, {}};
  for (const PointsInView& view : points_[detection.object_index]) {
    const Frame& other = sequence_.FrameOf(sequence_.detections[view.detection_index]);
    if (other.segment != frame.segment) continue;
    const Rigid3d camera_from_other = frame.world_from_camera.Inverse() * other.world_from_camera;
    const Eigen::Matrix3d rotation = camera_from_other.rotation.toRotationMatrix();
    for (ObjectPoint point : view.points) {
      point.position = camera_from_other * point.position;
      point.covariance = rotation * point.covariance * rotation.transpose();
      in_frame.points.push_back(point);
    }
  }
  if (in_frame.points.empty()) return std::nullopt;
  std::vector<Landmark> landmarks;
  for (const Hypothesis& one : hypotheses) landmarks.push_back(one.landmark_in_camera);
  return PointEvidence{in_frame.points, SizeForPoints(landmarks), PointWeight({in_frame}, options_),
                       options_};
}

}  // namespace soslam
