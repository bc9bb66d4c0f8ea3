// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "geometry/batch.h"
#include "geometry/camera.h"
#include "geometry/mirrored_points.h"
#include "initialisation/landmark_cost.h"

namespace soslam {

// Residuals between a map's values at some pixels and at their mirror pixels (eq. 16), on the
// surfaces of similar landmarks: d / sqrt(d^2 + scale^2) for each difference d, 1 if a pixel or its
// mirror image has no value. The batched equivalent of SymmetryDescriptor.
class MirrorResiduals {
 public:
  // `unit` is the unit of the map's values, `mirror_plane` as in VisibleSurface::MirrorImage.
  MirrorResiduals(const cv::Mat& map, double unit, const Camera& camera,
                  const std::vector<Eigen::Vector2d>& pixels, double mirror_plane, double scale);

  // Half the sum of squared residuals.
  double Value(const Landmark& landmark_in_camera) const;
  // Adds the same, multiplied by a weight, and its derivatives to `sum`.
  void AddTo(const Landmark& landmark_in_camera, double weight, LandmarkModel* sum) const;

 private:
  class View;

  const cv::Mat map_;
  double unit_;
  Camera camera_;
  double mirror_plane_;
  double scale_;
  PixelRays rays_;
  std::vector<Batch> values_;    // map values at the pixels
  std::vector<Batch> is_pixel_;  // 1 for pixels, 0 for the padding of the last batch
};

}  // namespace soslam
