// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end_variables.h"

#include <algorithm>

namespace soslam {
namespace {

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
    : input_(input), normal_of_plane_(SharedNormals(input.sequence.planes)) {
  const Sequence& sequence = input.sequence;
  const auto add = [&](VariableKind kind, size_t count) {
    const auto first = static_cast<int>(all_.size());
    all_.insert(all_.end(), count, {kind, nullptr});
    return first;
  };
  add(VariableKind::kPose, sequence.frames.size());
  first_landmark_ = add(VariableKind::kLandmark, input.starts.size());
  first_normal_ = add(VariableKind::kNormal, sequence.planes.size());
  first_offset_ = add(VariableKind::kOffset, sequence.planes.size());
  add(VariableKind::kBias, 1);
  size_t size = 0;
  for (const Variable& variable : all_) size += static_cast<size_t>(NumValues(variable.kind));
  values_.assign(size, 0.0);
  double* next = values_.data();
  for (Variable& variable : all_) {
    variable.values = next;
    next += NumValues(variable.kind);
  }
  const auto values = [&](int index) { return all_[static_cast<size_t>(index)].values; };
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    std::ranges::copy(ToParameterBlock(sequence.frames[i].world_from_camera), values(Pose(i)));
  }
  for (size_t i = 0; i < input.starts.size(); ++i) {
    if (input.starts[i]) std::ranges::copy(ToParameterBlock(*input.starts[i]), values(Landmark(i)));
  }
  for (size_t i = 0; i < sequence.planes.size(); ++i) {
    const Plane& plane = sequence.planes[i].plane_in_world;
    if (normal_of_plane_[i] == i) Eigen::Map<Eigen::Vector3d>(values(Normal(i))) = plane.normal;
    const Eigen::Map<const Eigen::Vector3d> shared(values(Normal(i)));
    side_of_plane_.push_back(shared == plane.normal ? 1.0 : -1.0);
    *values(Offset(i)) = plane.offset;
  }
}

Rigid3d BackEndVariables::PoseValue(size_t frame_index) const {
  return UnpackPose(Values(Pose(frame_index)));
}

Plane BackEndVariables::PlaneValue(size_t plane_index) const {
  Plane plane = UnpackPlane(Values(Normal(plane_index)), Values(Offset(plane_index)));
  plane.normal *= NormalSide(plane_index);
  return plane;
}

std::optional<soslam::Landmark> BackEndVariables::LandmarkValue(size_t object_index) const {
  const auto& start = input_.starts[object_index];
  if (!start) return std::nullopt;
  soslam::Landmark landmark = UnpackLandmark(Values(Landmark(object_index)));
  landmark.shape_exponent = start->shape_exponent;
  return landmark;
}

std::array<double, 4> BackEndVariables::BiasValues() const {
  std::array<double, kBiasSize> biases;
  std::copy_n(Values(Bias()), kBiasSize, biases.begin());
  return biases;
}

}  // namespace soslam
