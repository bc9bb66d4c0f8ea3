// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "geometry/batch.h"
#include "geometry/box.h"
#include "geometry/camera.h"
#include "image/edge_maps.h"
#include "initialisation/landmark_cost.h"
#include "orientation/model_edges.h"
#include "orientation/options.h"

namespace soslam {

// What edges are compared with in one frame.
struct FrameEdges {
  explicit FrameEdges(EdgeMaps edge_maps);

  EdgeMaps maps;
  cv::Mat slope_x, slope_y;  // CV_32FC1: across the edge through each edge pixel, of any length
};

// The same for one observation.
struct EdgeImage {
  std::shared_ptr<const FrameEdges> frame;
  Box box;                        // of the observation
  std::vector<Box> nearer_boxes;  // of objects that may hide this one
};

// How far the visible edges of a body lie from edges in the image. Each model point costs its
// distance to the nearest edge pixel (px / sigma), truncated softly (Geman-McClure). Points count
// as one observation for every options.edge_correlation_px of the box's perimeter, since neighbours
// on an edge say the same.
//
// Which points count is decided where the term is made, on the start: those inside the image,
// outside nearer boxes, and with an image edge nearest to them that runs their way. The others cost
// as much as a point far from any edge: an edge that is not seen speaks for no landmark.
class EdgeTerm final : public LandmarkCost {
 public:
  EdgeTerm(std::shared_ptr<const EdgeImage> image, const Camera& camera,
           const Landmark& start_in_camera, const EdgeOptions& options);

  // Those that count.
  int NumPoints() const { return num_points_; }
  // The share of the largest possible cost that a landmark near the start does not have: 1 when all
  // its points lie on edges, 0 when none is near one.
  double Support(const Landmark& landmark_in_camera) const;
  // Scales the cost.
  void Weigh(double factor) { weight_ *= factor; }

  double Value(const Landmark& landmark_in_camera) const override;
  void AddTo(const Landmark& landmark_in_camera, LandmarkModel* sum) const override;
  double ConstantCost() const override { return points_that_do_not_count_ * LargestCost(); }
  bool HasKinks() const override { return true; }

 private:
  bool Counts(const ModelPoint& point, const Landmark& start_in_camera) const;
  void Keep(const std::vector<ModelPoint>& points);
  // Of one point.
  double LargestCost() const {
    return 0.5 * weight_ * options_.edge_truncation_px * options_.edge_truncation_px;
  }

  std::shared_ptr<const EdgeImage> image_;
  Camera camera_;
  EdgeOptions options_;
  double least_cosine_;  // of the angle between a model point's direction and its edge's
  std::vector<BatchOfVectors> in_unit_body_;
  std::vector<Batch> is_point_;  // 1, and 0 behind the last point of the last batch
  int num_points_ = 0;
  double points_that_do_not_count_ = 0.0;
  double weight_;  // of a squared distance in px
};

// The same for the back end, its cost multiplied by `weight` and by the square of the start's
// support: where a body's edges are not seen in the image, as those of a chair's cuboid are not,
// what they happen to lie near says nothing.
EdgeTerm SupportedEdgeTerm(std::shared_ptr<const EdgeImage> image, const Camera& camera,
                           const Landmark& start_in_camera, const EdgeOptions& options,
                           double weight);

}  // namespace soslam
