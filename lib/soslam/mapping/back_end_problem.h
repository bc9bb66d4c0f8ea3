// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/ceres.h>

#include <deque>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "soslam/initialisation/points_in_frames.h"
#include "soslam/mapping/back_end.h"
#include "soslam/mapping/back_end_variables.h"
#include "soslam/mapping/options.h"
#include "soslam/model/estimates.h"

namespace soslam {

// The least squares problem of eq. (1), its variables, and a summary of its residuals. Keeps
// references to its arguments.
class BackEndProblem {
 public:
  // With odometry, detections, support and ratio constraints, preferred axes and the prior of the
  // detector's bias.
  BackEndProblem(const BackEndInput& input, const OptimiseOptions& options, int threads = 1);
  BackEndProblem(const BackEndProblem&) = delete;
  BackEndProblem& operator=(const BackEndProblem&) = delete;

  // Adds the residuals of texture, edges and points, and replaces those of an earlier call. Which
  // surface points see each other in the mirror, which edges of a body are visible, and how wide
  // the densities of points are, depends on the landmarks: call this when boxes and planes have
  // converged.
  void RenewImageResiduals();

  // Minimises from the present values of the variables. Throws NumericalError if the cost is not
  // defined there.
  void Solve(int max_iterations = std::numeric_limits<int>::max());

  // Minimises without a record in the summary, until a step lowers the cost by a smaller share than
  // least_tolerance, or than that of Solve if it is larger; does not throw.
  ceres::Solver::Summary Minimise(int max_iterations, double least_tolerance = 0.0);

  // The part of the boxes in the present cost.
  double BoxCost();

  // Before max_iterations are reached.
  int IterationsLeft() const { return options_.max_iterations - summary_.iterations; }

  // Replaces the second derivatives of points by their Fisher information, as covariances need.
  void PrepareCovariances();

  // The points of an object at its present landmark; none without a landmark.
  std::vector<PointPosterior> ComputePosteriors(size_t object_index) const;

  const SolverSummary& summary() const { return summary_; }
  ceres::Problem& problem() { return problem_; }
  BackEndVariables& variables() { return variables_; }
  const BackEndVariables& variables() const { return variables_; }

 private:
  // Residuals of images or points for one landmark.
  struct ImageBlocks {
    ImageResiduals residuals;
    bool of_points = false;
  };

  bool IsTangency() const { return options_.detection_model == DetectionModel::kTangency; }
  void WeighViews();
  void AddOdometry();
  void AddLandmark(size_t object_index);
  void AddStanding(size_t object_index);
  void AddDetections();
  void AddDetection(size_t index, const Landmark& initial_in_camera);
  void SetManifolds();  // and which poses are constant
  ImageBlocks BlocksOfImage(size_t index, const ImageEvidence& image) const;
  PointCost MakePointCost(size_t object_index, const PointsInView& view,
                          const Landmark& start_in_camera) const;
  ImageBlocks PointBlocks(size_t object_index, const PointsInView& view) const;
  void AddImageBlocks(size_t index, ImageBlocks blocks);

  // A detection's landmark in its camera, at the present values of the variables.
  Landmark LandmarkInCamera(const Detection& detection) const;
  double* Pose(const Detection& detection) { return variables_.Pose(detection.frame_index); }
  double* LandmarkOf(const Detection& detection) {
    return variables_.Landmark(detection.object_index);
  }

  const BackEndInput& input_;
  const OptimiseOptions& options_;
  int threads_;
  std::vector<std::vector<int>> detections_by_object_;  // indices
  std::vector<double> view_weights_;                    // one per detection
  BackEndVariables variables_;
  ceres::HuberLoss loss_;
  std::deque<ceres::ScaledLoss> view_losses_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> box_blocks_;
  std::vector<ceres::ResidualBlockId> image_blocks_;  // of texture and edges
  std::vector<ceres::ResidualBlockId> point_blocks_;
  std::set<std::string> image_residuals_, images_without_residuals_;  // their names in the summary
  PointCost::SecondDerivatives second_derivatives_of_points_ =
      PointCost::SecondDerivatives::kMaximisation;
  SolverSummary summary_;
};

}  // namespace soslam
