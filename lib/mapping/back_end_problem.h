// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/ceres.h>

#include <deque>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "constraints/parameters.h"
#include "mapping/back_end.h"
#include "mapping/options.h"
#include "model/estimates.h"

namespace soslam {

// The one problem of eq. (1), its variables, and what went into it. Keeps references to its
// arguments.
class BackEndProblem {
 public:
  // With odometry, detections, support and ratio constraints.
  BackEndProblem(const BackEndInput& input, const OptimiseOptions& options);

  // Which surface points see each other in the mirror, and which edges of a body are visible,
  // depends on the landmarks: texture and edges join in when boxes and planes have settled. Those
  // of an earlier call are replaced.
  void RenewImageTerms();

  // Minimises from where the variables are. Throws NumericalError when there is no usable solution.
  void Solve();

  const SolverSummary& summary() const { return summary_; }
  ceres::Problem& problem() { return problem_; }
  const double* LandmarkData(size_t object_index) const { return landmarks_[object_index].data(); }
  // In the world, where the variables are; none for objects without a start.
  std::vector<std::optional<Landmark>> Landmarks() const;
  const std::vector<PoseBlock>& poses() const { return poses_; }
  std::vector<Plane> Planes();
  // Normal and offset of each plane that something stands on.
  std::map<size_t, std::pair<const double*, const double*>> PlaneData();

 private:
  void HoldPoses();
  void WeighViews();
  void AddOdometry();
  void AddPlanes();
  void AddLandmark(size_t object_index);
  void AddStanding(size_t object_index);
  void AddRatio(size_t object_index);
  void AddDetections();
  void AddDetection(size_t index, const Landmark& landmark_in_camera);
  void AddSymmetry(size_t index, const std::shared_ptr<const SymmetryImage>& image);
  void AddPairs(size_t index, const std::shared_ptr<const SymmetryImage>& image,
                const Landmark& landmark_in_camera);
  void AddAsymmetry(size_t index, const std::shared_ptr<const SymmetryImage>& image,
                    const Landmark& landmark_in_camera);
  void AddEdges(size_t index, const std::shared_ptr<const EdgeImage>& image);
  void HoldBias();
  Landmark LandmarkInWorld(size_t object_index) const;
  // A detection's landmark as its camera sees it, where the variables are.
  Landmark LandmarkInCamera(const Detection& detection) const;
  PoseBlock& Pose(const Detection& detection) {
    return poses_[static_cast<size_t>(detection.frame_index)];
  }
  double* NormalOf(size_t plane_index) {
    return &plane_blocks_[kNormalSize * normal_of_plane_[plane_index]];
  }
  double* OffsetOf(size_t plane_index) {
    return &plane_blocks_[kNormalSize * normal_of_plane_.size() + plane_index];
  }
  LandmarkBlock& LandmarkOf(const Detection& detection) {
    return landmarks_[static_cast<size_t>(detection.object_index)];
  }
  std::shared_ptr<ceres::ParameterBlockOrdering> LandmarkOrdering();
  std::shared_ptr<ceres::ParameterBlockOrdering> Ordering();

  const BackEndInput& input_;
  const OptimiseOptions& options_;
  ceres::HuberLoss loss_;
  std::vector<double> view_weights_;  // one per detection
  std::deque<ceres::ScaledLoss> view_losses_;
  ceres::Problem problem_;
  std::vector<PoseBlock> poses_;
  std::vector<LandmarkBlock> landmarks_;
  std::vector<size_t> normal_of_plane_;  // parallel planes share the normal of the first
  // Of Sequence::planes: all normals, then all offsets. One array, as the solver sorts by address.
  std::vector<double> plane_blocks_;
  std::array<double, 4> detector_bias_px_{};  // left, top, right, bottom
  std::vector<ceres::ResidualBlockId> image_terms_;
  SolverSummary summary_;
};

}  // namespace soslam
