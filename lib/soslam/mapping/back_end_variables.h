// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "soslam/constraints/parameters.h"
#include "soslam/mapping/back_end.h"

namespace soslam {

// The parameter blocks of the back end (see parameters.h): a pose for each frame, a landmark for
// each object, normal and offset of each plane, the detector's bias at each side of a box, and
// the logarithm of the factor of all focal lengths. They
// begin at the input's values. Keeps a reference to the input.
//
// All are in one array, as Ceres sorts blocks by their address: the order of blocks, on which last
// digits depend, is then the same in every run.
class BackEndVariables {
 public:
  explicit BackEndVariables(const BackEndInput& input);
  BackEndVariables(const BackEndVariables&) = delete;
  BackEndVariables& operator=(const BackEndVariables&) = delete;

  double* Pose(size_t frame_index) { return &values_[kPoseSize * frame_index]; }
  double* Landmark(size_t object_index) {
    return &values_[first_landmark_ + kLandmarkSize * object_index];
  }
  // Parallel planes that are estimated share the block of their normal; NormalSide is -1 for those
  // of which it is the opposite, else 1.
  double* Normal(size_t plane_index) {
    return &values_[first_normal_ + kNormalSize * planes_[plane_index].shared];
  }
  double NormalSide(size_t plane_index) const { return planes_[plane_index].side; }
  double* Offset(size_t plane_index) { return &values_[first_offset_ + plane_index]; }
  double* Bias(size_t side) { return &values_[first_bias_ + side]; }
  double* LogFocal() { return &values_.back(); }

  // The values of all blocks.
  const std::vector<double>& values() const { return values_; }
  void SetValues(const std::vector<double>& values) { std::ranges::copy(values, values_.begin()); }

  // A frame's pose in the world.
  Rigid3d PoseValue(size_t frame_index) const {
    return UnpackPose(&values_[kPoseSize * frame_index]);
  }
  // The landmarks of all objects; none without an initial estimate.
  std::vector<std::optional<soslam::Landmark>> LandmarkValues() const;
  soslam::Landmark LandmarkValue(size_t object_index) const;  // needs an initial estimate
  Plane PlaneValue(size_t plane_index) const;
  std::array<double, 4> BiasValues() const;
  double FocalFactor() const { return std::exp(values_.back()); }

 private:
  // Which normal a plane has: that of the first parallel plane, or its opposite.
  struct PlaneNormal {
    size_t shared;  // index of that plane
    double side;
  };

  const BackEndInput& input_;
  std::vector<PlaneNormal> planes_;
  size_t first_landmark_, first_normal_, first_offset_, first_bias_;
  std::vector<double> values_;
};

}  // namespace soslam
