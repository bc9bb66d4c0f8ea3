// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "initialisation/landmark_cost.h"
#include "mapping/back_end.h"
#include "mapping/back_end_variables.h"
#include "mapping/normal_equations.h"
#include "mapping/options.h"
#include "model/estimates.h"

namespace soslam {

// The one problem of eq. (1), its variables, and what went into it. Keeps references to its
// arguments.
class BackEndProblem {
 public:
  // With odometry, detections, support and ratio constraints.
  BackEndProblem(const BackEndInput& input, const OptimiseOptions& options, int threads = 1);

  // Which surface points see each other in the mirror, and which edges of a body are visible,
  // depends on the landmarks: texture and edges join in when boxes and planes have settled. Those
  // of an earlier call are replaced.
  void RenewImageTerms();

  // Minimises from where the variables are, with so many iterations at most and no more than the
  // options say. `hardly_damped_near`: see MinimiseOptions. Throws NumericalError where the cost is
  // not defined there.
  void Solve(int max_iterations = std::numeric_limits<int>::max());

  const SolverSummary& summary() const { return summary_; }
  // Where Solve has left them.
  BackEndVariables& variables() { return variables_; }
  const BackEndVariables& variables() const { return variables_; }
  Terms AllTerms() const;

 private:
  void HoldPoses();
  void WeighViews();
  void AddOdometry();
  void AddLandmark(size_t object_index);
  void AddStanding(size_t object_index);
  void AddRatio(size_t object_index);
  void AddDetections();
  void AddDetection(size_t index, const Landmark& start_in_camera);
  void AddBias();

  // What one image says of one landmark, where the variables are; or why nothing.
  struct ImageTerms {
    const char* kind;
    const char* reason_for_none;
    int residuals;
    std::vector<std::unique_ptr<const Term>> terms;
  };
  ImageTerms AsymmetryOf(size_t index, const std::shared_ptr<const SymmetryImage>& image) const;
  ImageTerms PairsOf(size_t index, const std::shared_ptr<const SymmetryImage>& image) const;
  ImageTerms EdgesOf(size_t index, const std::shared_ptr<const EdgeImage>& image) const;
  std::unique_ptr<const Term> ViewTermOf(const Detection& detection,
                                         const Landmark& landmark_in_camera,
                                         std::unique_ptr<const LandmarkCost> cost) const;
  void AddImageTerms(ImageTerms of_image);

  // A detection's landmark as its camera sees it, where the variables are.
  Landmark LandmarkInCamera(const Detection& detection) const;
  int Pose(const Detection& detection) const {
    return variables_.Pose(static_cast<size_t>(detection.frame_index));
  }
  int LandmarkOf(const Detection& detection) const {
    return variables_.Landmark(static_cast<size_t>(detection.object_index));
  }
  // A residual block of these variables, which are of these kinds; `arguments` are the residual's.
  template <typename Residual, VariableKind... kKinds, typename... Arguments>
  std::unique_ptr<const Term> TermOf(const std::array<int, sizeof...(kKinds)>& variables,
                                     double huber_delta, Arguments&&... arguments) const;

  const BackEndInput& input_;
  const OptimiseOptions& options_;
  int threads_;
  std::vector<std::vector<int>> detections_by_object_;
  std::vector<double> view_weights_;  // one per detection
  BackEndVariables variables_;
  std::set<int> normals_under_objects_;
  std::vector<std::unique_ptr<const Term>> terms_;
  std::vector<std::unique_ptr<const Term>> image_terms_;
  SolverSummary summary_;
};

}  // namespace soslam
