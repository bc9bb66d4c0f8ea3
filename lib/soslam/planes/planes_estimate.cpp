// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/planes_estimate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "soslam/geometry/angles.h"

namespace soslam {

Sequence WithPlanes(Sequence sequence, const PlanesEstimate& estimate) {
  sequence.planes.clear();
  for (const EstimatedPlane& plane : estimate.planes) {
    sequence.planes.push_back({static_cast<int>(sequence.planes.size()), plane.plane_in_world,
                               estimate.attitude_information, plane.height_prior});
  }
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    sequence.objects[i].plane_index = estimate.objects[i].plane_index;
  }
  constexpr const char* kReason = "no_support";
  const auto left_out = std::erase_if(sequence.detections, [&](const Detection& detection) {
    const auto& support = estimate.objects[detection.object_index];
    if (support.reason != SupportReason::kNone) return false;
    sequence.rejected.push_back(Rejected(sequence, detection, RejectingStage::kPlanes, kReason));
    return true;
  });
  if (left_out > 0) sequence.rejected_detections[kReason] += static_cast<int>(left_out);
  for (Detection& detection : sequence.detections) {
    const auto plane = static_cast<size_t>(sequence.ObjectOf(detection).plane_index);
    detection.plane_in_camera = Transform(sequence.FrameOf(detection).world_from_camera.Inverse(),
                                          sequence.planes[plane].plane_in_world);
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
  const auto most =
      std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; });
  const Plane& truth = given.planes[most->first].plane_in_world;
  const EstimatedPlane& found = estimate.planes[plane_index];
  return PlaneError{most->first, AngleBetween(found.plane_in_world.normal, truth.normal),
                    truth.SignedDistance(found.point_in_world)};
}

namespace {

EstimatedPlane MeanOf(const std::vector<Rigid3d>& world_from_camera, double height_m) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  Eigen::Vector3d below = Eigen::Vector3d::Zero();
  for (const Rigid3d& pose : world_from_camera) {
    up -= pose.rotation * Eigen::Vector3d::UnitY();
    below += pose * Eigen::Vector3d(0.0, height_m, 0.0);
  }
  EstimatedPlane plane;
  plane.point_in_world = below / static_cast<double>(world_from_camera.size());
  const Eigen::Vector3d normal = up.normalized();
  plane.plane_in_world = {normal, -normal.dot(plane.point_in_world)};
  plane.x_axis_in_world = UprightRotation(normal, 0.0) * Eigen::Vector3d::UnitX();
  return plane;
}

}  // namespace

Plane GroundInCamera(double height_m) { return {-Eigen::Vector3d::UnitY(), height_m}; }

PlanesEstimate PlanesBelowCameras(const Sequence& sequence, double height_m) {
  PlanesEstimate estimate;
  const std::vector<Rigid3d> all = PosesOf(sequence);
  estimate.up_of_cameras = MeanOf(all, height_m).plane_in_world.normal;
  estimate.settled = true;
  for (const std::vector<int>& detections : DetectionsByObject(sequence)) {
    std::vector<Rigid3d> poses;
    for (const int index : detections) {
      const Detection& detection = sequence.detections[index];
      poses.push_back(all[detection.frame_index]);
    }
    const int plane_index = static_cast<int>(estimate.planes.size());
    estimate.planes.push_back(MeanOf(poses.empty() ? all : poses, height_m));
    estimate.objects.push_back(
        {plane_index,
         poses.empty() ? SupportReason::kNoViews : SupportReason::kCameraHeight,
         {},
         {},
         {}});
  }
  return estimate;
}

PlaneRow MakePlaneRow(const EstimatedPlane& plane, int id, double tilt_variance) {
  PlaneRow row = {id, plane.plane_in_world, plane.point_in_world, plane.x_axis_in_world,
                  plane.covariance};
  if (const auto& covariance = plane.covariance) {
    row.tilt_sigma_deg =
        kDegPerRad * std::sqrt((*covariance)(0, 0) + (*covariance)(1, 1) + tilt_variance);
    row.height_sigma_m = std::sqrt((*covariance)(2, 2));
  }
  return row;
}

PlanesReport MakeReport(const PlanesEstimate& estimate, const Sequence& given) {
  PlanesReport report;
  report.dataset = given.name;
  for (int i = 0; i < std::ssize(estimate.planes); ++i) {
    PlanesReport::EstimatedPlaneRow row = {
        MakePlaneRow(estimate.planes[i], i, estimate.orientation_tilt_variance)};
    if (const auto error = CompareWithGiven(given, estimate, i)) {
      row.error = {given.planes[error->given_plane_index].id, kDegPerRad * error->angle,
                   error->offset};
    }
    report.planes.push_back(row);
  }
  for (size_t i = 0; i < estimate.objects.size(); ++i) {
    const ObjectSupport& support = estimate.objects[i];
    std::optional<int> plane;
    if (support.reason != SupportReason::kNone) plane = support.plane_index;
    report.objects.push_back({given.objects[i].id, given.objects[i].label, plane, support.reason,
                              support.height, support.height_sigma, support.cost});
  }
  report.up_of_cameras_in_world = estimate.up_of_cameras;
  if (!estimate.orientations.empty()) {
    report.camera_holding = {estimate.orientation, estimate.verticals,
                             estimate.orientation_tilt_variance == 0.0, estimate.orientations};
  }
  report.cost = estimate.cost;
  report.rounds = estimate.rounds;
  report.settled = estimate.settled;
  return report;
}

}  // namespace soslam
