// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mirrored_points.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <tuple>

#include "base/wide_loops.h"
#include "geometry/body_in_camera.h"
#include "geometry/support_function.h"

namespace soslam {
namespace {

SOSLAM_IN_WIDE_LOOPS void LoadVectors(const BatchOfVectors& vectors, int at, ThreeFours* four) {
  for (size_t k = 0; k < 3; ++k) Load(vectors[k].data() + at, &(*four)[k]);
}

SOSLAM_IN_WIDE_LOOPS void Dot(const ThreeFours& a, const ThreeFours& b, Four* dot) {
  *dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

SOSLAM_IN_WIDE_LOOPS void StoreOnes(const FourMask& mask, int* to) {
  using FourIntegers [[gnu::vector_size(4 * sizeof(int))]] = int;
  const FourIntegers ones = __builtin_convertvector(mask & 1, FourIntegers);
  std::memcpy(to, &ones, sizeof(ones));
}

SOSLAM_IN_WIDE_LOOPS void StoreOnes(const EightMask& mask, int* to) {
  const EightMask ones = mask & 1;
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
      const Four coordinate = image_from_object(k, 0) * mirror_image[0] +
                              image_from_object(k, 1) * mirror_image[1] +
                              image_from_object(k, 2) * mirror_image[2] + image_from_object(k, 3);
      const FourFloats floats = __builtin_convertvector(coordinate, FourFloats);
      std::memcpy(mirrored->in_image[k].data() + at, &floats, sizeof(floats));
    }
  }
}

// An ellipsoid in coordinates that make it the unit ball.
struct UnitBall {
  UnitBall(const Landmark& landmark, const Camera& camera) {
    const Eigen::Matrix3d rotation = landmark.frame_from_object.rotation.toRotationMatrix();
    const Eigen::Matrix3d ball_from_camera =
        landmark.half_axes.cwiseInverse().asDiagonal() * rotation.transpose();
    from_camera = ball_from_camera.cast<float>();
    camera_in_ball = (-(ball_from_camera * landmark.Centre())).cast<float>();
    squared_axes = landmark.half_axes.cwiseAbs2().cast<float>();
    Eigen::Matrix<double, 3, 4> image_from_object =
        camera.ProjectionMatrix(landmark.frame_from_object);
    image_from_object.leftCols<3>() *= landmark.half_axes.asDiagonal();
    image_from_ball = image_from_object.cast<float>();
  }

  Eigen::Matrix3f from_camera;
  Eigen::Vector3f camera_in_ball;
  Eigen::Vector3f squared_axes;
  Eigen::Matrix<float, 3, 4> image_from_ball;
};

// As BodySurface::Meet and MirrorVisible, in single precision. Rays are followed from the point
// that is closest to the centre: from the camera, rounding would be larger by the ratio of its
// distance to the body's size. The normal is p / axes, its product with a direction that of p with
// the direction in the ball, where p is the point there.
SOSLAM_WIDE_LOOPS void MirrorVisibleOnEllipsoid(const UnitBall& ball, const PixelRays& rays,
                                                double min_viewing_cosine,
                                                std::vector<MirroredBatch>* mirrored) {
  using ThreeEights = std::array<Eight, 3>;
  using EightDoubles
      [[gnu::vector_size(8 * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] =
          double;
  const auto [turn, camera, squared_axes, matrix] = ball;
  const Eigen::Vector3f squared_inverse_axes = squared_axes.cwiseInverse();
  const auto squared_cosine = static_cast<float>(min_viewing_cosine * min_viewing_cosine);
  const double* rays_x = rays.x.data();
  const double* rays_y = rays.y.data();
  for (size_t i = 0; i < rays.x.size(); i += 8) {
    const Eight x =
        __builtin_convertvector(*reinterpret_cast<const EightDoubles*>(rays_x + i), Eight);
    const Eight y =
        __builtin_convertvector(*reinterpret_cast<const EightDoubles*>(rays_y + i), Eight);
    ThreeEights ray, closest, point, to_camera;
    Eight squared_ray{}, along{};
    for (int k = 0; k < 3; ++k) {
      ray[k] = turn(k, 0) * x + turn(k, 1) * y + turn(k, 2);
      squared_ray += ray[k] * ray[k];
      along += camera[k] * ray[k];
    }
    const Eight by_squared_ray = 1.0F / squared_ray;
    const Eight depth_of_closest = -along * by_squared_ray;
    Eight squared_half_chord = Eight{} + 1.0F, half_chord;
    for (int k = 0; k < 3; ++k) {
      closest[k] = camera[k] + depth_of_closest * ray[k];
      squared_half_chord -= closest[k] * closest[k];
    }
    SquareRoot(squared_half_chord * by_squared_ray, &half_chord);  // NaN for a ray that misses
    const EightMask is_on_surface = depth_of_closest > half_chord;
    Eight squared_normal{}, squared_to_camera{}, there = Eight{} - 1.0F;
    for (int k = 0; k < 3; ++k) {
      point[k] = closest[k] - half_chord * ray[k];
      squared_normal += squared_inverse_axes[k] * (point[k] * point[k]);
      if (k == 1) point[k] = -point[k];  // from here on the mirror image
      to_camera[k] = camera[k] - point[k];
      squared_to_camera += squared_axes[k] * (to_camera[k] * to_camera[k]);
      there += point[k] * camera[k];
    }
    const Eight least = squared_cosine * squared_normal;
    MirroredBatch& batch = (*mirrored)[i / kBatchSize];
    const size_t at = i % kBatchSize;
    StoreOnes(is_on_surface, batch.is_on_surface.data() + at);
    StoreOnes(is_on_surface & (squared_half_chord * squared_ray >= least * (x * x + y * y + 1.0F)) &
                  (there >= 0.0F) & (there * there >= least * squared_to_camera),
              batch.is_visible.data() + at);
    for (int k = 0; k < 3; ++k) {
      Store(matrix(k, 0) * point[0] + matrix(k, 1) * point[1] + matrix(k, 2) * point[2] +
                matrix(k, 3),
            batch.in_image[k].data() + at);
    }
  }
}

}  // namespace

PixelRays::PixelRays(const Camera& of_camera, const std::vector<Eigen::Vector2d>& pixels)
    : camera(of_camera),
      count(pixels.size()),
      x((count + kBatchSize - 1) / kBatchSize * kBatchSize, 0.0),
      y(x) {
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d ray = camera.Ray(pixels[i]);
    x[i] = ray.x();
    y[i] = ray.y();
  }
}

void MirroredPoints::Find(const Landmark& landmark_in_camera, const PixelRays& rays,
                          double min_viewing_cosine) {
  mirrored_.resize(rays.x.size() / kBatchSize);
  const UnitBall ball(landmark_in_camera, rays.camera);
  const bool is_around_camera = !(ball.camera_in_ball.squaredNorm() > 1.0F);
  if (landmark_in_camera.shape_exponent == kEllipsoidExponent && !is_around_camera) {
    MirrorVisibleOnEllipsoid(ball, rays, min_viewing_cosine, &mirrored_);
  } else {
    const BodyInCamera body(landmark_in_camera);
    const Eigen::Matrix<double, 3, 4> image_from_object =
        rays.camera.ProjectionMatrix(landmark_in_camera.frame_from_object);
    RayBatch met;
    for (size_t i = 0; i < mirrored_.size(); ++i) {
      body.Meet(rays.x.data() + i * kBatchSize, rays.y.data() + i * kBatchSize, &met);
      MirrorVisible(met, body.camera_in_object, image_from_object, min_viewing_cosine,
                    &mirrored_[i]);
    }
  }
  Pack(rays.count);
}

void MirroredPoints::Pack(size_t num_rays) {
  // Every ray is written where the next one that counts belongs.
  ray.resize(num_rays + 1);
  for (auto& coordinate : in_image) coordinate.resize(num_rays + kBatchSize);
  // Copies, as what is written may be anything to the compiler.
  const auto [x, y, depth] = std::tuple(in_image[0].data(), in_image[1].data(), in_image[2].data());
  size_t* const rays = ray.data();
  size_t hits = 0, found = 0, next = 0;
  for (const MirroredBatch& batch : mirrored_) {
    const size_t count = std::min<size_t>(num_rays - next, kBatchSize);
    for (size_t i = 0; i < count; ++i) {
      x[found] = batch.in_image[0][i];
      y[found] = batch.in_image[1][i];
      depth[found] = batch.in_image[2][i];
      rays[found] = next++;
      hits += static_cast<size_t>(batch.is_on_surface[i]);
      found += static_cast<size_t>(batch.is_visible[i]);
    }
  }
  on_surface = hits;
  ray.resize(found);
  for (auto& coordinate : in_image) {
    const float last = found > 0 ? coordinate[found - 1] : 0.0F;
    coordinate.resize(found);
    coordinate.resize((found + kBatchSize - 1) / kBatchSize * kBatchSize, last);
  }
}

}  // namespace soslam
