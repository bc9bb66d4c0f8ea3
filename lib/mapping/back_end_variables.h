// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "constraints/tangent_space.h"
#include "mapping/back_end.h"

namespace soslam {

// A variable of the back end, its values where its terms read them.
struct Variable {
  VariableKind kind;
  double* values;
  bool is_held = false;
};

// The variables of the back end: a pose for each frame, a landmark for each object, normal and
// offset of each plane, and the detector's bias at the edges of a box (px). They start where the
// input has them. Keeps a reference to the input.
class BackEndVariables {
 public:
  explicit BackEndVariables(const BackEndInput& input);
  BackEndVariables(const BackEndVariables&) = delete;
  BackEndVariables& operator=(const BackEndVariables&) = delete;

  std::vector<Variable>& all() { return all_; }
  const std::vector<Variable>& all() const { return all_; }

  // Indices into all(), of each kind in ascending order, the kinds one after the other.
  int Pose(size_t frame_index) const { return static_cast<int>(frame_index); }
  int Landmark(size_t object_index) const {
    return first_landmark_ + static_cast<int>(object_index);
  }
  // Parallel planes that are estimated share the block of their normal; NormalSide is -1 for those
  // of which it is the opposite, else 1.
  int Normal(size_t plane_index) const {
    return first_normal_ + static_cast<int>(normal_of_plane_[plane_index]);
  }
  double NormalSide(size_t plane_index) const { return side_of_plane_[plane_index]; }
  int Offset(size_t plane_index) const { return first_offset_ + static_cast<int>(plane_index); }
  int Bias() const { return static_cast<int>(all_.size()) - 1; }

  void Hold(int index) { all_[static_cast<size_t>(index)].is_held = true; }
  const double* Values(int index) const { return all_[static_cast<size_t>(index)].values; }

  // In the world.
  Rigid3d PoseValue(size_t frame_index) const;
  Plane PlaneValue(size_t plane_index) const;
  std::optional<soslam::Landmark> LandmarkValue(size_t object_index) const;  // none without a start
  std::array<double, 4> BiasValues() const;

 private:
  const BackEndInput& input_;
  std::vector<size_t> normal_of_plane_;
  std::vector<double> side_of_plane_;
  int first_landmark_, first_normal_, first_offset_;
  std::vector<double> values_;
  std::vector<Variable> all_;
};

}  // namespace soslam
