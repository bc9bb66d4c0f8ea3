// SPDX-License-Identifier: BSD-3-Clause
#include "planes/planes_estimate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace soslam {

Sequence WithPlanes(Sequence sequence, const PlanesEstimate& estimate) {
  sequence.planes.clear();
  for (const EstimatedPlane& plane : estimate.planes) {
    sequence.planes.push_back({static_cast<int>(sequence.planes.size()), plane.plane_in_world,
                               estimate.attitude_information});
  }
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    sequence.objects[i].plane_index = estimate.objects[i].plane_index;
  }
  constexpr const char* kReason = "no_support";
  const auto left_out = std::erase_if(sequence.detections, [&](const Detection& detection) {
    const auto& support = estimate.objects[static_cast<size_t>(detection.object_index)];
    if (support.reason != SupportReason::kNone) return false;
    sequence.rejected.push_back(Rejected(sequence, detection, RejectingStage::kPlanes, kReason));
    return true;
  });
  if (left_out > 0) sequence.rejected_detections[kReason] += static_cast<int>(left_out);
  for (Detection& detection : sequence.detections) {
    const Object& object = sequence.objects[static_cast<size_t>(detection.object_index)];
    const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
    detection.plane_in_camera =
        Transform(frame.world_from_camera.Inverse(),
                  sequence.planes[static_cast<size_t>(object.plane_index)].plane_in_world);
  }
  return sequence;
}

std::optional<PlaneError> CompareWithGiven(const Sequence& given, const PlanesEstimate& estimate,
                                           int plane_index) {
  std::map<int, int> votes;
  for (size_t i = 0; i < given.objects.size(); ++i) {
    const ObjectSupport& support = estimate.objects[i];
    if (support.reason == SupportReason::kNone) continue;
    if (support.plane_index == plane_index) ++votes[given.objects[i].plane_index];
  }
  if (votes.empty() || given.planes.empty()) return std::nullopt;
  const auto most = std::max_element(
      votes.begin(), votes.end(),
      [](const auto& one, const auto& other) { return one.second < other.second; });
  const Plane& truth = given.planes[static_cast<size_t>(most->first)].plane_in_world;
  const EstimatedPlane& found = estimate.planes[static_cast<size_t>(plane_index)];
  const Eigen::Vector3d& normal = found.plane_in_world.normal;
  return PlaneError{most->first,
                    std::atan2(normal.cross(truth.normal).norm(), normal.dot(truth.normal)),
                    truth.SignedDistance(found.point_in_world)};
}

}  // namespace soslam
