// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end_variables.h"

namespace soslam {
namespace {

// Index of the first plane whose normal is the same or opposite, if both planes are estimated; else
// that of the plane itself.
size_t FirstParallelPlane(const std::vector<SupportPlane>& planes, size_t index) {
  const SupportPlane& plane = planes[index];
  for (size_t i = 0; i < index && plane.attitude_information; ++i) {
    if (!planes[i].attitude_information) continue;
    const Eigen::Vector3d& normal = planes[i].plane_in_world.normal;
    if (normal == plane.plane_in_world.normal || normal == -plane.plane_in_world.normal) return i;
  }
  return index;
}

}  // namespace

BackEndVariables::BackEndVariables(const BackEndInput& input) : input_(input) {
  for (const Frame& frame : input.sequence.frames) {
    poses_.push_back(ToParameterBlock(frame.world_from_camera));
  }
  for (const auto& initial : input.starts) {
    landmarks_.push_back(initial ? ToParameterBlock(*initial) : LandmarkBlock{});
  }
  const auto& planes = input.sequence.planes;
  for (size_t i = 0; i < planes.size(); ++i) {
    const Plane& plane = planes[i].plane_in_world;
    const size_t shared = FirstParallelPlane(planes, i);
    const bool is_opposite = planes[shared].plane_in_world.normal != plane.normal;
    planes_.push_back({shared, plane.normal, is_opposite ? -1.0 : 1.0, plane.offset});
  }
}

Plane BackEndVariables::PlaneValue(size_t plane_index) const {
  const PlaneVariables& plane = planes_[plane_index];
  return {plane.side * planes_[plane.shared].normal, plane.offset};
}

Landmark BackEndVariables::LandmarkValue(size_t object_index) const {
  soslam::Landmark landmark = UnpackLandmark(landmarks_[object_index].data());
  landmark.shape_exponent = input_.starts[object_index]->shape_exponent;
  return landmark;
}

std::vector<std::optional<Landmark>> BackEndVariables::LandmarkValues() const {
  std::vector<std::optional<soslam::Landmark>> landmarks(landmarks_.size());
  for (size_t i = 0; i < landmarks.size(); ++i) {
    if (input_.starts[i]) landmarks[i] = LandmarkValue(i);
  }
  return landmarks;
}

}  // namespace soslam
