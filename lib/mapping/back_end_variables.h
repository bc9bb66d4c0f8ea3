// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "constraints/parameters.h"
#include "mapping/back_end.h"

namespace soslam {

// The parameter blocks of the back end (see parameters.h): a pose for each frame, a landmark for
// each object, normal and offset of each plane, and the detector's bias at each side of a box. They
// begin at the input's values. Keeps a reference to the input.
class BackEndVariables {
 public:
  explicit BackEndVariables(const BackEndInput& input);
  BackEndVariables(const BackEndVariables&) = delete;
  BackEndVariables& operator=(const BackEndVariables&) = delete;

  double* Pose(size_t frame_index) { return poses_[frame_index].data(); }
  double* Landmark(size_t object_index) { return landmarks_[object_index].data(); }
  // Parallel planes that are estimated share the block of their normal; NormalSide is -1 for those
  // of which it is the opposite, else 1.
  double* Normal(size_t plane_index) { return planes_[planes_[plane_index].shared].normal.data(); }
  double NormalSide(size_t plane_index) const { return planes_[plane_index].side; }
  double* Offset(size_t plane_index) { return &planes_[plane_index].offset; }
  double* Bias(size_t side) { return &bias_px_[side]; }

  // In the world.
  Rigid3d PoseValue(size_t frame_index) const { return UnpackPose(poses_[frame_index].data()); }
  // Of every object: none without an initial estimate.
  std::vector<std::optional<soslam::Landmark>> LandmarkValues() const;
  soslam::Landmark LandmarkValue(size_t object_index) const;  // needs an initial estimate
  Plane PlaneValue(size_t plane_index) const;
  const std::array<double, 4>& BiasValues() const { return bias_px_; }

 private:
  struct PlaneVariables {
    size_t shared;           // index of the first parallel plane, whose normal is used
    Eigen::Vector3d normal;  // used if it is the first itself
    double side;
    double offset;
  };

  const BackEndInput& input_;
  std::vector<PoseBlock> poses_;
  std::vector<LandmarkBlock> landmarks_;
  std::vector<PlaneVariables> planes_;
  std::array<double, 4> bias_px_{};
};

}  // namespace soslam
