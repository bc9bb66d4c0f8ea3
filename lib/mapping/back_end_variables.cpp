// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end_variables.h"

#include <algorithm>

namespace soslam {
namespace {

constexpr size_t kEdges = 4;

std::vector<size_t> SharedNormals(const std::vector<SupportPlane>& planes) {
  const auto are_parallel = [](const SupportPlane& one, const SupportPlane& other) {
    const Eigen::Vector3d& normal = one.plane_in_world.normal;
    const Eigen::Vector3d& other_normal = other.plane_in_world.normal;
    return one.attitude_information && other.attitude_information &&
           (normal == other_normal || normal == -other_normal);
  };
  std::vector<size_t> normals;
  for (size_t i = 0; i < planes.size(); ++i) {
    size_t first = 0;
    while (first < i && !are_parallel(planes[first], planes[i])) ++first;
    normals.push_back(first);
  }
  return normals;
}

}  // namespace

BackEndVariables::BackEndVariables(const BackEndInput& input)
    : input_(input),
      normal_of_plane_(SharedNormals(input.sequence.planes)),
      landmarks_begin_(kPoseSize * input.sequence.frames.size()),
      normals_begin_(landmarks_begin_ + kLandmarkSize * input.starts.size()),
      offsets_begin_(normals_begin_ + kNormalSize * input.sequence.planes.size()),
      biases_begin_(offsets_begin_ + kOffsetSize * input.sequence.planes.size()),
      values_(biases_begin_ + kEdges, 0.0) {
  const Sequence& sequence = input.sequence;
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    std::ranges::copy(Pack(sequence.frames[i].world_from_camera), Pose(i));
  }
  for (size_t i = 0; i < input.starts.size(); ++i) {
    if (input.starts[i]) std::ranges::copy(Pack(*input.starts[i]), Landmark(i));
  }
  for (size_t i = 0; i < sequence.planes.size(); ++i) {
    const Plane& plane = sequence.planes[i].plane_in_world;
    if (normal_of_plane_[i] == i) Eigen::Map<Eigen::Vector3d>(Normal(i)) = plane.normal;
    const Eigen::Map<const Eigen::Vector3d> shared(Normal(i));
    side_of_plane_.push_back(shared == plane.normal ? 1.0 : -1.0);
    *Offset(i) = plane.offset;
  }
}

Rigid3d BackEndVariables::PoseValue(size_t frame_index) const {
  return UnpackPose(&values_[kPoseSize * frame_index]);
}

Plane BackEndVariables::PlaneValue(size_t plane_index) const {
  Plane plane = UnpackPlane(&values_[normals_begin_ + kNormalSize * normal_of_plane_[plane_index]],
                            &values_[offsets_begin_ + plane_index]);
  plane.normal *= NormalSide(plane_index);
  return plane;
}

std::optional<soslam::Landmark> BackEndVariables::LandmarkValue(size_t object_index) const {
  const auto& start = input_.starts[object_index];
  if (!start) return std::nullopt;
  soslam::Landmark landmark =
      UnpackLandmark(&values_[landmarks_begin_ + kLandmarkSize * object_index]);
  landmark.shape_exponent = start->shape_exponent;
  return landmark;
}

std::array<double, 4> BackEndVariables::BiasValues() const {
  std::array<double, kEdges> biases;
  std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(biases_begin_), kEdges, biases.begin());
  return biases;
}

}  // namespace soslam
