// SPDX-License-Identifier: BSD-3-Clause
#include "symmetry/sampling.h"

#include "geometry/mirror_mapping.h"

namespace soslam {

std::vector<Eigen::Vector2d> SamplePixels(const EdgeMaps& maps, const Camera& camera,
                                          const Landmark& landmark_in_camera, const Box& box,
                                          const SymmetryOptions& options) {
  const VisibleSurface surface(camera, landmark_in_camera);
  std::vector<Eigen::Vector2d> samples;
  if (options.sampling != Sampling::kUniform) {
    for (const Eigen::Vector2f& corner : maps.corners) {
      if (samples.size() >= static_cast<size_t>(options.max_corners)) break;
      const Eigen::Vector2d pixel = corner.cast<double>();
      if (box.Contains(pixel) && surface.FromPixel(pixel)) samples.push_back(pixel);
    }
  }
  if (options.sampling != Sampling::kCorners) {
    const int columns = options.uniform_columns;
    for (int row = 0; row < columns; ++row) {
      for (int column = 0; column < columns; ++column) {
        const Eigen::Vector2d pixel(box.x_min + (column + 0.5) / columns * box.Width(),
                                    box.y_min + (row + 0.5) / columns * box.Height());
        if (surface.FromPixel(pixel)) samples.push_back(pixel);
      }
    }
  }
  return samples;
}

}  // namespace soslam
