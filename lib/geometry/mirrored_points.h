// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/batch.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"

namespace soslam {

// The viewing rays of many pixels, z = 1, as Camera::Ray gives them one by one; and rays along the
// optical axis up to whole batches.
struct PixelRays {
  PixelRays(const Camera& of_camera, const std::vector<Eigen::Vector2d>& pixels);

  Camera camera;
  size_t count;
  std::vector<double> x;
  std::vector<double> y;
};

// The mirror images of a batch in the image (see MirroredPoints), and which of them count (1 or 0).
struct MirroredBatch {
  std::array<std::array<float, kBatchSize>, 3> in_image;
  std::array<int, kBatchSize> is_on_surface;
  std::array<int, kBatchSize> is_visible;
};

// Of many rays at once what VisibleSurface::FromPixel, ViewingCosine and MirrorImage give one by
// one. One object serves many landmarks, and takes no memory anew.
class MirroredPoints {
 public:
  void Find(const Landmark& landmark_in_camera, const PixelRays& rays, double min_viewing_cosine);

  size_t on_surface = 0;  // how many rays meet the surface
  // The mirror images in the xz plane of those points that the camera sees, as it sees their mirror
  // images, with a viewing cosine of at least min_viewing_cosine >= 0; in the image: depth times
  // pixel x, depth times pixel y, and depth (m). Whole batches: the last point is repeated.
  std::array<std::vector<float>, 3> in_image;
  std::vector<size_t> ray;  // of each of these points
  size_t NumBatches() const { return in_image[0].size() / kBatchSize; }

 private:
  // Keeps what is visible of the mirror images of all rays.
  void Pack(size_t num_rays);

  std::vector<MirroredBatch> mirrored_;
};

}  // namespace soslam
