// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "soslam/constraints/landmark_cost.h"
#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"
#include "soslam/image/edge_maps.h"
#include "soslam/orientation/options.h"

namespace soslam {

// A point of an object's surface that should be on an edge in the image.
struct ModelPoint {
  Eigen::Vector3d in_unit_body;  // in the object frame, divided by the half axes
  Eigen::Vector2d along;         // direction of the edge in the image, unit length
};

// Points about `spacing_px` apart along the visible edges of a landmark: the edges of its cuboid
// that belong to a visible face if it is boxy, its silhouette if it is rounder. None unless the
// whole landmark is in front of the camera.
std::vector<ModelPoint> VisibleModelPoints(const Camera& camera, const Landmark& landmark_in_camera,
                                           double spacing_px);

// Edges of one image, with which the edges of landmarks are compared.
struct FrameEdges {
  explicit FrameEdges(EdgeMaps edge_maps);

  EdgeMaps maps;
  cv::Mat slope_x,
      slope_y;  // CV_32FC1: image gradient, orthogonal to the edge through each edge pixel
};

// The edges as seen by one observation.
struct EdgeImage {
  std::shared_ptr<const FrameEdges> frame;
  Box box;                        // of the observation
  std::vector<Box> nearer_boxes;  // of objects that may occlude this one
};

// Distance of an object's visible edges from edges in the image. Each model point costs its
// distance to the nearest edge pixel (px / sigma) under a Geman-McClure loss. All points together
// have the weight of one observation per options.edge_correlation_px of the box's perimeter, since
// errors of neighbouring points are correlated.
//
// The points to use are chosen at construction, for the initial landmark: those inside the image,
// outside nearer boxes, and whose nearest image edge has about their direction. The others cost as
// much as a point far from any edge, whatever the landmark: an edge that is not seen supports no
// landmark.
class EdgeCost final : public LandmarkCost {
 public:
  EdgeCost(std::shared_ptr<const EdgeImage> image, const Camera& camera,
           const Landmark& start_in_camera, const EdgeOptions& options);

  // Number of points that are used.
  int NumPoints() const { return static_cast<int>(in_unit_body_.size()); }
  // Fraction of the largest possible cost that a landmark near the initial one avoids: 1 when all
  // its points lie on edges, 0 when none is near one.
  double Support(const Landmark& landmark_in_camera) const;
  // Multiplies the cost by a factor.
  void Weigh(double factor) { weight_ *= factor; }

  double Value(const Landmark& landmark_in_camera) const override;
  void AddTo(const Landmark& landmark_in_camera, LandmarkModel* sum) const override;
  double ConstantCost() const override { return points_that_do_not_count_ * LargestCost(); }
  bool ConvergesSlowly() const override { return true; }

 private:
  bool Counts(const ModelPoint& point, const Landmark& start_in_camera) const;
  // Residual (px) of a point of the body, and its derivative; the loss is included.
  double Residual(const Landmark& landmark, const Eigen::Matrix3d& rotation,
                  const Eigen::Vector3d& in_unit_body, LandmarkJacobian1* jacobian) const;
  // Largest cost of one point.
  double LargestCost() const {
    return 0.5 * weight_ * options_.edge_truncation_px * options_.edge_truncation_px;
  }

  std::shared_ptr<const EdgeImage> image_;
  Camera camera_;
  EdgeOptions options_;
  double least_cosine_;                        // cosine of edge_direction_tolerance_deg
  std::vector<Eigen::Vector3d> in_unit_body_;  // points that are used
  double points_that_do_not_count_ = 0.0;
  double weight_;  // of a squared distance in px^2
};

}  // namespace soslam
