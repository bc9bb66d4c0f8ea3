// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/symmetry_samples.h"

#include <algorithm>

#include "geometry/mirror_mapping.h"

namespace soslam {

void ForEachSample(const SymmetryImage& image, const SymmetryOptions& options,
                   const std::function<bool(const Eigen::Vector2d&)>& add) {
  const Box& box = image.box;
  if (options.sampling == Sampling::kEdges) {
    // Every stride-th edge pixel, so that they are thinned evenly.
    const auto max_count = static_cast<size_t>(options.max_edge_pixels);
    const size_t stride =
        std::max<size_t>(1, (image.edge_pixels.size() + max_count - 1) / max_count);
    for (size_t i = 0; i < image.edge_pixels.size(); i += stride) add(image.edge_pixels[i]);
    return;
  }
  if (options.sampling != Sampling::kUniform) {
    int corners = 0;
    for (const Eigen::Vector2f& corner : image.maps.corners) {
      const Eigen::Vector2d pixel = corner.cast<double>();
      if (corners < options.max_corners && box.Contains(pixel) && add(pixel)) ++corners;
    }
  }
  if (options.sampling != Sampling::kCorners) {
    const int columns = options.uniform_columns;
    for (int row = 0; row < columns; ++row) {
      for (int column = 0; column < columns; ++column) {
        add({box.x_min + (column + 0.5) / columns * box.Width(),
             box.y_min + (row + 0.5) / columns * box.Height()});
      }
    }
  }
}

std::vector<Eigen::Vector2d> SamplePixels(const SymmetryImage& image, const Camera& camera,
                                          const Landmark& landmark_in_camera,
                                          const SymmetryOptions& options) {
  const VisibleSurface surface(camera, landmark_in_camera);
  std::vector<Eigen::Vector2d> samples;
  ForEachSample(image, options, [&](const Eigen::Vector2d& pixel) {
    const bool is_on_landmark = surface.FromPixel(pixel).has_value();
    if (is_on_landmark) samples.push_back(pixel);
    return is_on_landmark;
  });
  return samples;
}

}  // namespace soslam
