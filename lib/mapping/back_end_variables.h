// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "constraints/parameters.h"
#include "mapping/back_end.h"

namespace soslam {

// The parameter blocks of the back end: a pose for each frame, a landmark for each object, normal
// and offset of each plane, and the detector's bias at each edge of a box (left, top, right,
// bottom; px). They start where the input has them. All are in one array: solvers sort blocks by
// address, and so have them in the same order in every run. Keeps a reference to the input.
class BackEndVariables {
 public:
  explicit BackEndVariables(const BackEndInput& input);

  double* Pose(size_t frame_index) { return &values_[kPoseSize * frame_index]; }
  double* Landmark(size_t object_index) {
    return &values_[landmarks_begin_ + kLandmarkSize * object_index];
  }
  // Parallel planes that are estimated share the block of their normal; NormalSide is -1 for those
  // of which it is the opposite, else 1.
  double* Normal(size_t plane_index) {
    return &values_[normals_begin_ + kNormalSize * normal_of_plane_[plane_index]];
  }
  double NormalSide(size_t plane_index) const { return side_of_plane_[plane_index]; }
  double* Offset(size_t plane_index) { return &values_[offsets_begin_ + plane_index]; }
  double* Bias(size_t edge) { return &values_[biases_begin_ + edge]; }

  // In the world.
  Rigid3d PoseValue(size_t frame_index) const;
  Plane PlaneValue(size_t plane_index) const;
  std::optional<soslam::Landmark> LandmarkValue(size_t object_index) const;  // none without a start
  std::array<double, 4> BiasValues() const;

 private:
  const BackEndInput& input_;
  std::vector<size_t> normal_of_plane_;
  std::vector<double> side_of_plane_;
  size_t landmarks_begin_, normals_begin_, offsets_begin_, biases_begin_;
  std::vector<double> values_;
};

}  // namespace soslam
