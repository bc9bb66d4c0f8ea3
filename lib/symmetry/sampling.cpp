// SPDX-License-Identifier: BSD-3-Clause
#include "symmetry/sampling.h"

#include <algorithm>
#include <cmath>

#include "geometry/mirror_mapping.h"

namespace soslam {

namespace {

// The edge pixels of a box row by row, thinned evenly to at most `max_count`.
std::vector<Eigen::Vector2d> EdgePixels(const EdgeMaps& maps, const Box& box, int max_count) {
  std::vector<Eigen::Vector2d> pixels;
  const int y_end = std::min(maps.edges.rows, static_cast<int>(std::floor(box.y_max)) + 1);
  const int x_end = std::min(maps.edges.cols, static_cast<int>(std::floor(box.x_max)) + 1);
  for (int y = std::max(0, static_cast<int>(std::ceil(box.y_min))); y < y_end; ++y) {
    for (int x = std::max(0, static_cast<int>(std::ceil(box.x_min))); x < x_end; ++x) {
      if (maps.edges.at<unsigned char>(y, x) != 0) pixels.emplace_back(x, y);
    }
  }
  const size_t stride = (pixels.size() + max_count - 1) / static_cast<size_t>(max_count);
  if (stride <= 1) return pixels;
  std::vector<Eigen::Vector2d> thinned;
  for (size_t i = 0; i < pixels.size(); i += stride) thinned.push_back(pixels[i]);
  return thinned;
}

}  // namespace

std::vector<Eigen::Vector2d> SamplePixels(const EdgeMaps& maps, const Camera& camera,
                                          const Landmark& landmark_in_camera, const Box& box,
                                          const SymmetryOptions& options) {
  const VisibleSurface surface(camera, landmark_in_camera);
  std::vector<Eigen::Vector2d> samples;
  if (options.sampling == Sampling::kEdges) {
    for (const Eigen::Vector2d& pixel : EdgePixels(maps, box, options.max_edge_pixels)) {
      if (surface.FromPixel(pixel)) samples.push_back(pixel);
    }
    return samples;
  }
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
