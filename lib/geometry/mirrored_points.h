// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "geometry/batch.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"

namespace soslam {

// The viewing rays of many pixels, z = 1, as Camera::Ray gives them one by one.
struct PixelRays {
  PixelRays(const Camera& camera, const std::vector<Eigen::Vector2d>& pixels);

  std::vector<double> x;
  std::vector<double> y;
};

// Of many rays at once what VisibleSurface::FromPixel, ViewingCosine and MirrorImage give one by
// one. One object serves many landmarks, and takes no memory anew.
class MirroredPoints {
 public:
  void Find(const Landmark& landmark_in_camera, const PixelRays& rays, double min_viewing_cosine);

  size_t on_surface = 0;  // how many rays meet the surface
  // The mirror images in the xz plane, in the camera frame, of those points that the camera sees,
  // as it sees their mirror images, with a viewing cosine of at least min_viewing_cosine >= 0.
  // Batch by batch; what is left of the last one is NaN.
  std::vector<BatchOfVectors> in_camera;
  std::vector<size_t> ray;  // of each of these points

 private:
  void Append(const BatchOfVectors& points, Eigen::Index index);
};

}  // namespace soslam
