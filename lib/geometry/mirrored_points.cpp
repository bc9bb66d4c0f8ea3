// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mirrored_points.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <tuple>

#include "base/wide_loops.h"
#include "geometry/body_in_camera.h"

namespace soslam {
namespace {

// The mirror images of a batch in the image (see MirroredPoints), and which of them count (1 or 0).
struct MirroredBatch {
  std::array<std::array<float, kBatchSize>, 3> in_image;
  alignas(kFourAlignment) std::array<std::int64_t, kBatchSize> is_on_surface;
  alignas(kFourAlignment) std::array<std::int64_t, kBatchSize> is_visible;
};

SOSLAM_IN_WIDE_LOOPS void LoadVectors(const BatchOfVectors& vectors, int at, ThreeFours* four) {
  for (size_t k = 0; k < 3; ++k) Load(vectors[k].data() + at, &(*four)[k]);
}

SOSLAM_IN_WIDE_LOOPS void Dot(const ThreeFours& a, const ThreeFours& b, Four* dot) {
  *dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

SOSLAM_IN_WIDE_LOOPS void StoreOnes(const FourMask& mask, std::int64_t* to) {
  const FourMask ones = mask & 1;
  std::memcpy(to, &ones, sizeof(ones));
}

// Whether v, the dot product of normal and direction to the camera, is at least cosine |normal|
// |direction|.
SOSLAM_IN_WIDE_LOOPS void IsSeen(const Four& v, const Four& squared_normal,
                                 const Four& squared_to_camera, double squared_cosine,
                                 FourMask* is_seen) {
  *is_seen = (v >= 0.0) & (v * v >= squared_cosine * squared_normal * squared_to_camera);
}

// Visible is what the camera sees on both sides. `image_from_object` is 3 x 4.
SOSLAM_WIDE_LOOPS void MirrorVisible(const RayBatch& rays, const Eigen::Vector3d& camera,
                                     const Eigen::Matrix<double, 3, 4>& image_from_object,
                                     double min_viewing_cosine, MirroredBatch* mirrored) {
  using FourFloats [[gnu::vector_size(4 * sizeof(float))]] = float;
  const double squared_cosine = min_viewing_cosine * min_viewing_cosine;
  const Eigen::Matrix<double, 3, 4> matrix = image_from_object;
  for (int at = 0; at < kBatchSize; at += 4) {
    ThreeFours point, normal, ray;
    LoadVectors(rays.point, at, &point);
    LoadVectors(rays.gradient, at, &normal);
    LoadVectors(rays.direction, at, &ray);
    const ThreeFours mirror_image = {point[0], -point[1], point[2]};
    const ThreeFours mirrored_normal = {normal[0], -normal[1], normal[2]};
    const ThreeFours to_camera = {camera.x() - point[0], camera.y() + point[1],
                                  camera.z() - point[2]};
    Four squared_normal, away, squared_ray, there, squared_to, depth;
    Dot(normal, normal, &squared_normal);
    Dot(normal, ray, &away);
    Dot(ray, ray, &squared_ray);
    Dot(mirrored_normal, to_camera, &there);
    Dot(to_camera, to_camera, &squared_to);
    Load(rays.depth.data() + at, &depth);
    const FourMask is_on_surface = depth > 0.0;
    StoreOnes(is_on_surface, mirrored->is_on_surface.data() + at);
    FourMask is_seen, is_mirror_image_seen;
    IsSeen(-away, squared_normal, squared_ray, squared_cosine, &is_seen);
    IsSeen(there, squared_normal, squared_to, squared_cosine, &is_mirror_image_seen);
    StoreOnes(is_on_surface & is_seen & is_mirror_image_seen, mirrored->is_visible.data() + at);
    for (int k = 0; k < 3; ++k) {
      const Four coordinate = matrix(k, 0) * mirror_image[0] + matrix(k, 1) * mirror_image[1] +
                              matrix(k, 2) * mirror_image[2] + matrix(k, 3);
      const FourFloats floats = __builtin_convertvector(coordinate, FourFloats);
      std::memcpy(mirrored->in_image[k].data() + at, &floats, sizeof(floats));
    }
  }
}

}  // namespace

PixelRays::PixelRays(const Camera& of_camera, const std::vector<Eigen::Vector2d>& pixels)
    : camera(of_camera) {
  for (const Eigen::Vector2d& pixel : pixels) {
    const Eigen::Vector3d ray = camera.Ray(pixel);
    x.push_back(ray.x());
    y.push_back(ray.y());
  }
}

void MirroredPoints::Find(const Landmark& landmark_in_camera, const PixelRays& rays,
                          double min_viewing_cosine) {
  const BodyInCamera body(landmark_in_camera);
  const Eigen::Matrix<double, 3, 4> image_from_object =
      rays.camera.ProjectionMatrix(landmark_in_camera.frame_from_object);
  on_surface = 0;
  // Every ray is written where the next one that counts belongs.
  ray.resize(rays.x.size() + 1);
  for (auto& coordinate : in_image) coordinate.resize(rays.x.size() + kBatchSize);
  const auto [x, y, depth] = std::tuple(in_image[0].data(), in_image[1].data(), in_image[2].data());
  size_t found = 0;
  RayBatch batch;
  MirroredBatch mirrored;
  for (size_t begin = 0; begin < rays.x.size(); begin += kBatchSize) {
    const size_t count = std::min<size_t>(rays.x.size() - begin, kBatchSize);
    body.Meet(rays.x.data() + begin, rays.y.data() + begin, count, &batch);
    MirrorVisible(batch, body.camera_in_object, image_from_object, min_viewing_cosine, &mirrored);
    for (size_t i = 0; i < count; ++i) {
      x[found] = mirrored.in_image[0][i];
      y[found] = mirrored.in_image[1][i];
      depth[found] = mirrored.in_image[2][i];
      ray[found] = begin + i;
      on_surface += static_cast<size_t>(mirrored.is_on_surface[i]);
      found += static_cast<size_t>(mirrored.is_visible[i]);
    }
  }
  ray.resize(found);
  for (auto& coordinate : in_image) {
    const float last = found > 0 ? coordinate[found - 1] : 0.0F;
    coordinate.resize(found);
    coordinate.resize((found + kBatchSize - 1) / kBatchSize * kBatchSize, last);
  }
}

}  // namespace soslam
