// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/edges_on_surface.h"

#include <algorithm>
#include <limits>

#include "base/wide_loops.h"
#include "geometry/body_in_camera.h"
#include "geometry/mirrored_points.h"

namespace soslam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Per element of the batches: the smallest squared distance so far, and the index of its batch.
struct Least {
  Batch squared = Batch::Constant(kInfinity);
  Batch batch = Batch::Zero();
};

SOSLAM_MULTIVERSION void Compare(const Eigen::Vector3d& point,
                                 const BatchOfVectors& __restrict edges, double batch,
                                 Least* __restrict least) {
  const double x = point.x(), y = point.y(), z = point.z();
  for (int i = 0; i < kBatchSize; ++i) {
    const double dx = edges[0][i] - x, dy = edges[1][i] - y, dz = edges[2][i] - z;
    const double squared = dx * dx + dy * dy + dz * dz;
    const bool is_less = squared < least->squared[i];  // false for NaN
    least->squared[i] = is_less ? squared : least->squared[i];
    least->batch[i] = is_less ? batch : least->batch[i];
  }
}

}  // namespace

EdgesOnSurface::EdgesOnSurface(const Camera& camera, const Landmark& landmark_in_camera,
                               const std::vector<Eigen::Vector2d>& edge_pixels) {
  const BodyInCamera body(landmark_in_camera);
  const PixelRays rays(camera, edge_pixels);
  RayBatch met;
  for (size_t begin = 0; begin < edge_pixels.size(); begin += kBatchSize) {
    const size_t count = std::min<size_t>(edge_pixels.size() - begin, kBatchSize);
    body.Meet(rays.x.data() + begin, rays.y.data() + begin, &met);
    for (size_t i = 0; i < count; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (!(met.depth[at] > 0.0)) continue;
      const auto place = static_cast<Eigen::Index>(pixels_.size() % kBatchSize);
      if (place == 0) {
        in_object_.emplace_back().fill(Batch::Constant(std::numeric_limits<double>::quiet_NaN()));
      }
      for (size_t k = 0; k < 3; ++k) in_object_.back()[k][place] = met.point[k][at];
      pixels_.push_back(edge_pixels[begin + i]);
    }
  }
}

std::optional<Eigen::Vector2d> EdgesOnSurface::Nearest(
    const Eigen::Vector3d& point_in_object) const {
  Least least;
  for (size_t i = 0; i < in_object_.size(); ++i) {
    Compare(point_in_object, in_object_[i], static_cast<double>(i), &least);
  }
  const double smallest = least.squared.minCoeff();
  if (!(smallest < kInfinity)) return std::nullopt;
  size_t first = pixels_.size();
  for (int i = 0; i < kBatchSize; ++i) {
    if (least.squared[i] > smallest) continue;
    first = std::min(first, static_cast<size_t>(least.batch[i]) * kBatchSize + i);
  }
  return pixels_[first];
}

}  // namespace soslam
