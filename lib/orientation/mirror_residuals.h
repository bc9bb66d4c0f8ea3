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

// How much a map's values at some pixels differ from those at their mirror pixels (eq. 16), on the
// surfaces of landmarks near to each other: d / sqrt(d^2 + scale^2) of each difference d, 1 where a
// pixel or its mirror image has no value. SymmetryDescriptor says the same pair by pair.
class MirrorResiduals {
 public:
  // `unit` is that of the map's values, `mirror_plane` as in VisibleSurface::MirrorImage.
  MirrorResiduals(const cv::Mat& map, double unit, const Camera& camera,
                  const std::vector<Eigen::Vector2d>& pixels, double mirror_plane, double scale);

  // Half the sum of their squares.
  double Value(const Landmark& landmark_in_camera) const;
  // The same, multiplied by a weight.
  void AddTo(const Landmark& landmark_in_camera, double weight, LandmarkModel* sum) const;

 private:
  class View;

  const cv::Mat map_;
  double unit_;
  Camera camera_;
  double mirror_plane_;
  double scale_;
  PixelRays rays_;
  std::vector<Batch> values_;    // at the pixels
  std::vector<Batch> is_pixel_;  // 1, and 0 behind the last one
};

}  // namespace soslam
