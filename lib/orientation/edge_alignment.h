// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "geometry/box.h"
#include "geometry/camera.h"
#include "image/edge_maps.h"
#include "initialisation/upright.h"
#include "orientation/model_edges.h"
#include "orientation/options.h"

namespace soslam {

// What edges are compared with in one frame.
struct FrameEdges {
  explicit FrameEdges(EdgeMaps edge_maps);

  EdgeMaps maps;
  cv::Mat direction;  // CV_32FC1, rad modulo pi: of the edge through each edge pixel
};

// The same for one observation.
struct EdgeImage {
  std::shared_ptr<const FrameEdges> frame;
  Box box;                        // of the observation
  std::vector<Box> nearer_boxes;  // of objects that may hide this one
};

// How far the visible edges of a body lie from edges in the image. Each model point costs its
// distance to the nearest edge pixel (px / sigma), truncated softly (Geman-McClure). Residuals are
// scaled to count as one for every options.edge_correlation_px of the box's perimeter, since
// neighbours on an edge say the same.
//
// Which points count is decided where the term is made, on the start: those inside the image,
// outside nearer boxes, and with an image edge nearest to them that runs their way. The others cost
// as much as a point far from any edge: an edge that is not seen speaks for no landmark.
class EdgeTerm final : public LandmarkTerm {
 public:
  EdgeTerm(const EdgeImage& image, const Camera& camera, const Landmark& start_in_camera,
           const EdgeOptions& options);

  // The share of the largest possible cost that a landmark near the start does not have: 1 when all
  // its points lie on edges, 0 when none is near one.
  double Support(const Landmark& landmark_in_camera) const;
  // Scales the cost.
  void Weigh(double factor) { weight_ *= std::sqrt(factor); }

  int NumResiduals() const override { return static_cast<int>(points_.size()); }
  void Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                Jacobian* jacobian) const override;
  double ConstantCost() const override { return points_that_do_not_count_ * LargestCost(); }

 private:
  bool Counts(const ModelPoint& point, const Landmark& start_in_camera) const;
  // Of one point.
  double LargestCost() const { return 0.5 * std::pow(weight_ * options_.edge_truncation_px, 2); }

  const EdgeImage& image_;
  Camera camera_;
  EdgeOptions options_;
  std::vector<ModelPoint> points_;
  double points_that_do_not_count_ = 0.0;
  double weight_;
};

// The same for the back end, its cost multiplied by `weight` and by the square of the start's
// support: where a body's edges are not seen in the image, as those of a chair's cuboid are not,
// what they happen to lie near says nothing. Residuals: one per point. Blocks: world_from_camera,
// landmark in the world.
class EdgeAlignmentResidual final : public ceres::CostFunction {
 public:
  EdgeAlignmentResidual(std::shared_ptr<const EdgeImage> image, const Camera& camera,
                        const Landmark& start_in_camera, const EdgeOptions& options, double weight);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  std::shared_ptr<const EdgeImage> image_;
  EdgeTerm term_;
  double shape_exponent_;
};

}  // namespace soslam
