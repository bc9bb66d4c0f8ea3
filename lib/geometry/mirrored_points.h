// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/batch.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"

namespace soslam {

// The viewing rays of many pixels (z = 1, as from Camera::Ray), padded to whole batches with rays
// along the optical axis.
struct PixelRays {
  PixelRays(const Camera& of_camera, const std::vector<Eigen::Vector2d>& pixels);

  Camera camera;
  size_t count;
  std::vector<double> x;
  std::vector<double> y;
};

// The mirror images of one batch in the image (see MirroredPoints), and masks (1 or 0).
struct MirroredBatch {
  std::array<std::array<float, kBatchSize>, 3> in_image;
  std::array<int, kBatchSize> is_on_surface;
  std::array<int, kBatchSize> is_visible;
};

// VisibleSurface::FromPixel, ViewingCosine and MirrorImage for many rays at once. One object serves
// many landmarks and reuses its memory.
class MirroredPoints {
 public:
  void Find(const Landmark& landmark_in_camera, const PixelRays& rays, double min_viewing_cosine);

  size_t on_surface = 0;  // number of rays that meet the surface
  // The mirror images in the xz plane of visible points. Visible: the camera sees both the point
  // and its mirror image with a viewing cosine of at least min_viewing_cosine >= 0. Homogeneous
  // image coordinates: depth times pixel x, depth times pixel y, and depth (m). Padded to whole
  // batches by repeating the last point.
  std::array<std::vector<float>, 3> in_image;
  std::vector<size_t> ray;  // index of the ray of each visible point
  size_t NumBatches() const { return in_image[0].size() / kBatchSize; }

 private:
  // Fills the public members from `mirrored_`, keeping visible points only.
  void Pack(size_t num_rays);

  std::vector<MirroredBatch> mirrored_;
};

}  // namespace soslam
