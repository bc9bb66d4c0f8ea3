// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/ceres.h>

#include <deque>
#include <memory>
#include <vector>

#include "mapping/back_end.h"
#include "mapping/back_end_variables.h"
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
  // Where Solve has left them.
  BackEndVariables& variables() { return variables_; }

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
  // A detection's landmark as its camera sees it, where the variables are.
  Landmark LandmarkInCamera(const Detection& detection) const;
  double* Pose(const Detection& detection) {
    return variables_.Pose(static_cast<size_t>(detection.frame_index));
  }
  double* LandmarkOf(const Detection& detection) {
    return variables_.Landmark(static_cast<size_t>(detection.object_index));
  }
  std::shared_ptr<ceres::ParameterBlockOrdering> LandmarkOrdering();
  std::shared_ptr<ceres::ParameterBlockOrdering> Ordering();

  const BackEndInput& input_;
  const OptimiseOptions& options_;
  ceres::HuberLoss loss_;
  std::vector<double> view_weights_;  // one per detection
  std::deque<ceres::ScaledLoss> view_losses_;
  ceres::Problem problem_;
  BackEndVariables variables_;
  std::vector<ceres::ResidualBlockId> image_terms_;
  SolverSummary summary_;
};

}  // namespace soslam
