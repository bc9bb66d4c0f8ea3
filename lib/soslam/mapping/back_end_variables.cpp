// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/back_end_variables.h"

namespace soslam {
BackEndVariables::BackEndVariables(const BackEndInput& input)
    : input_(input),
      first_landmark_(kPoseSize * input.sequence.frames.size()),
      first_normal_(first_landmark_ + kLandmarkSize * input.initial_landmarks.size()),
      first_offset_(first_normal_ + kNormalSize * input.sequence.planes.size()),
      first_bias_(first_offset_ + kOffsetSize * input.sequence.planes.size()),
      values_(first_bias_ + 4 * kBiasSize + kLogFocalSize, 0.0) {
  const Sequence& sequence = input.sequence;
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    std::ranges::copy(ToParameterBlock(sequence.frames[i].world_from_camera), Pose(i));
  }
  for (size_t i = 0; i < input.initial_landmarks.size(); ++i) {
    if (input.initial_landmarks[i])
      std::ranges::copy(ToParameterBlock(*input.initial_landmarks[i]), Landmark(i));
  }
  for (size_t i = 0; i < sequence.planes.size(); ++i) {
    const Plane& plane = sequence.planes[i].plane_in_world;
    const auto is_estimated = [&](size_t k) { return sequence.planes[k].attitude_information; };
    const auto normal_of = [&](size_t k) { return sequence.planes[k].plane_in_world.normal; };
    size_t shared = is_estimated(i) ? 0 : i;
    while (shared < i && !(is_estimated(shared) && (normal_of(shared) == plane.normal ||
                                                    normal_of(shared) == -plane.normal))) {
      ++shared;
    }
    planes_.push_back({shared, normal_of(shared) == plane.normal ? 1.0 : -1.0});
    if (shared == i) std::ranges::copy(plane.normal, Normal(i));
    *Offset(i) = plane.offset;
  }
}

Plane BackEndVariables::PlaneValue(size_t plane_index) const {
  const PlaneNormal& plane = planes_[plane_index];
  const Eigen::Map<const Eigen::Vector3d> normal(
      &values_[first_normal_ + kNormalSize * plane.shared]);
  return {plane.side * normal, values_[first_offset_ + plane_index]};
}

std::array<double, 4> BackEndVariables::BiasValues() const {
  std::array<double, 4> biases;
  std::copy_n(&values_[first_bias_], biases.size(), biases.begin());
  return biases;
}

Landmark BackEndVariables::LandmarkValue(size_t object_index) const {
  soslam::Landmark landmark =
      UnpackLandmark(&values_[first_landmark_ + kLandmarkSize * object_index],
                     input_.initial_landmarks[object_index]->shape_exponents);
  landmark.rests_on = input_.initial_landmarks[object_index]->rests_on;
  return landmark;
}

std::vector<std::optional<Landmark>> BackEndVariables::LandmarkValues() const {
  std::vector<std::optional<soslam::Landmark>> landmarks(input_.initial_landmarks.size());
  for (size_t i = 0; i < landmarks.size(); ++i) {
    if (input_.initial_landmarks[i]) landmarks[i] = LandmarkValue(i);
  }
  return landmarks;
}

}  // namespace soslam
