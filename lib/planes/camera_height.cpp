// SPDX-License-Identifier: BSD-3-Clause
#include "planes/camera_height.h"

#include <Eigen/Geometry>

namespace soslam {
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
  std::vector<Rigid3d> all;
  for (const Frame& frame : sequence.frames) all.push_back(frame.world_from_camera);
  estimate.up_of_cameras = MeanOf(all, height_m).plane_in_world.normal;
  estimate.settled = true;
  for (const std::vector<int>& detections : DetectionsByObject(sequence)) {
    std::vector<Rigid3d> poses;
    for (const int index : detections) {
      const Detection& detection = sequence.detections[static_cast<size_t>(index)];
      poses.push_back(all[static_cast<size_t>(detection.frame_index)]);
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

}  // namespace soslam
