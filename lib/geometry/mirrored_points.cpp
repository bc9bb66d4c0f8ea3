// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mirrored_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/wide_loops.h"
#include "geometry/body_in_camera.h"

namespace soslam {
namespace {

std::array<const double*, 3> Data(const BatchOfVectors& vectors) {
  return {vectors[0].data(), vectors[1].data(), vectors[2].data()};
}

// Mirror images, in the camera frame, of the points where rays meet the surface. `excess` is 0 or
// more where the camera sees both: where v, the dot product of normal and direction to the camera,
// is at least min_viewing_cosine |normal| |direction|.
SOSLAM_WIDE_LOOPS void MirrorVisible(const RayBatch& __restrict rays, const BodyInCamera& body,
                                     double min_viewing_cosine, BatchOfVectors* __restrict mirrored,
                                     Batch* __restrict excess) {
  const Eigen::Matrix3d rotation = body.rotation;
  const Eigen::Vector3d centre = body.centre;
  const Eigen::Vector3d camera = body.camera_in_object;
  const double squared_cosine = min_viewing_cosine * min_viewing_cosine;
  const auto [x, y, z] = Data(rays.point);
  const auto [normal_x, normal_y, normal_z] = Data(rays.gradient);
  const auto [ray_x, ray_y, ray_z] = Data(rays.direction);
  for (int i = 0; i < kBatchSize; ++i) {
    const double least = squared_cosine * (normal_x[i] * normal_x[i] + normal_y[i] * normal_y[i] +
                                           normal_z[i] * normal_z[i]);
    const double here = -(normal_x[i] * ray_x[i] + normal_y[i] * ray_y[i] + normal_z[i] * ray_z[i]);
    const double squared_ray = ray_x[i] * ray_x[i] + ray_y[i] * ray_y[i] + ray_z[i] * ray_z[i];
    // From the mirror image, whose normal is mirrored as well.
    const double to_x = camera.x() - x[i];
    const double to_y = camera.y() + y[i];
    const double to_z = camera.z() - z[i];
    const double there = normal_x[i] * to_x - normal_y[i] * to_y + normal_z[i] * to_z;
    const double squared_to = to_x * to_x + to_y * to_y + to_z * to_z;
    (*excess)[i] = std::min(here * std::abs(here) - least * squared_ray,
                            there * std::abs(there) - least * squared_to);
    (*mirrored)[0][i] =
        rotation(0, 0) * x[i] - rotation(0, 1) * y[i] + rotation(0, 2) * z[i] + centre.x();
    (*mirrored)[1][i] =
        rotation(1, 0) * x[i] - rotation(1, 1) * y[i] + rotation(1, 2) * z[i] + centre.y();
    (*mirrored)[2][i] =
        rotation(2, 0) * x[i] - rotation(2, 1) * y[i] + rotation(2, 2) * z[i] + centre.z();
  }
}

}  // namespace

PixelRays::PixelRays(const Camera& camera, const std::vector<Eigen::Vector2d>& pixels) {
  for (const Eigen::Vector2d& pixel : pixels) {
    const Eigen::Vector3d ray = camera.Ray(pixel);
    x.push_back(ray.x());
    y.push_back(ray.y());
  }
}

void MirroredPoints::Append(const BatchOfVectors& points, Eigen::Index index) {
  const auto place = static_cast<Eigen::Index>(ray.size()) % kBatchSize;
  if (place == 0) {
    in_camera.emplace_back().fill(Batch::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  for (size_t i = 0; i < 3; ++i) in_camera.back()[i][place] = points[i][index];
}

void MirroredPoints::Find(const Landmark& landmark_in_camera, const PixelRays& rays,
                          double min_viewing_cosine) {
  const BodyInCamera body(landmark_in_camera);
  on_surface = 0;
  in_camera.clear();
  ray.clear();
  RayBatch batch;
  BatchOfVectors mirrored;
  Batch excess;
  for (size_t begin = 0; begin < rays.x.size(); begin += kBatchSize) {
    const size_t count = std::min<size_t>(rays.x.size() - begin, kBatchSize);
    body.Meet(rays.x.data() + begin, rays.y.data() + begin, count, &batch);
    MirrorVisible(batch, body, min_viewing_cosine, &mirrored, &excess);
    for (size_t i = 0; i < count; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (!(batch.depth[at] > 0.0)) continue;
      ++on_surface;
      if (!(excess[at] >= 0.0)) continue;
      Append(mirrored, at);
      ray.push_back(begin + i);
    }
  }
}

}  // namespace soslam
