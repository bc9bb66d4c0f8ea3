// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mirrored_points.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <tuple>

#include "base/simd.h"
#include "geometry/body_in_camera.h"
#include "geometry/support_function.h"

namespace soslam {
namespace {

SOSLAM_FORCE_INLINE void LoadVectors(const BatchOfVectors& vectors, int at, ThreeFours* four) {
  for (size_t k = 0; k < 3; ++k) Load(vectors[k].data() + at, &(*four)[k]);
}

SOSLAM_FORCE_INLINE void Dot(const ThreeFours& a, const ThreeFours& b, Four* dot) {
  *dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

SOSLAM_FORCE_INLINE void StoreOnes(const FourMask& mask, int* to) {
  using FourIntegers [[gnu::vector_size(4 * sizeof(int))]] = int;
  const FourIntegers ones = __builtin_convertvector(mask & 1, FourIntegers);
  std::memcpy(to, &ones, sizeof(ones));
}

SOSLAM_FORCE_INLINE void StoreOnes(const EightMask& mask, int* to) {
  const EightMask ones = mask & 1;
  std::memcpy(to, &ones, sizeof(ones));
}

// Tests whether v, the dot product of the normal and the direction to the camera, is at least
// cosine |normal| |direction|.
SOSLAM_FORCE_INLINE void IsSeen(const Four& v, const Four& squared_normal,
                                const Four& squared_to_camera, double squared_cosine,
                                FourMask* is_seen) {
  *is_seen = (v >= 0.0) & (v * v >= squared_cosine * squared_normal * squared_to_camera);
}

// Mirror images of the intersections, and masks. Visible: the camera sees both the point and its
// mirror image. `image_from_object` is the 3 x 4 projection matrix.
SOSLAM_MULTIVERSION void MirrorVisible(const RayBatch& rays, const Eigen::Vector3d& camera,
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

// An ellipsoid in coordinates in which it is the unit ball.
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

// A batch of floats, eight in each SIMD vector; and a batch of vectors.
using Eights = std::array<Eight, kBatchSize / 8>;
using ThreeEights = std::array<Eights, 3>;

// Rays in the coordinates of the ball.
struct RaysInBall {
  ThreeEights direction;
  Eights squared;           // squared length of the direction
  Eights inverse_squared;   // 1 / squared
  Eights depth_of_closest;  // depth of the point that is closest to the centre
  Eights length_in_camera;  // squared length of the direction in the camera frame
};

SOSLAM_FORCE_INLINE void TurnToBall(const UnitBall& ball, const double* rays_x,
                                    const double* rays_y, RaysInBall* rays) {
  using EightDoubles
      [[gnu::vector_size(8 * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] =
          double;
  for (size_t i = 0; i < rays->squared.size(); ++i) {
    const Eight x =
        __builtin_convertvector(*reinterpret_cast<const EightDoubles*>(rays_x + 8 * i), Eight);
    const Eight y =
        __builtin_convertvector(*reinterpret_cast<const EightDoubles*>(rays_y + 8 * i), Eight);
    Eight squared{}, along{};
    for (int k = 0; k < 3; ++k) {
      const Eight direction =
          ball.from_camera(k, 0) * x + ball.from_camera(k, 1) * y + ball.from_camera(k, 2);
      squared += direction * direction;
      along += ball.camera_in_ball[k] * direction;
      rays->direction[k][i] = direction;
    }
    rays->squared[i] = squared;
    rays->inverse_squared[i] = 1.0F / squared;
    rays->depth_of_closest[i] = -along * rays->inverse_squared[i];
    rays->length_in_camera[i] = x * x + y * y + 1.0F;
  }
}

struct PointsOnBall {
  std::array<EightMask, kBatchSize / 8> exist;
  Eights squared_half_chord;
  Eights half_chord;  // in units of the direction's length; NaN for a ray that misses
  ThreeEights mirror_image;
};

// Intersects the rays with the ball, starting from the point closest to the centre: from the
// camera, rounding errors would be larger by the ratio of its distance to the body's size.
SOSLAM_FORCE_INLINE void MeetBall(const UnitBall& ball, const RaysInBall& rays,
                                  PointsOnBall* points) {
  for (size_t i = 0; i < rays.squared.size(); ++i) {
    Eight squared_half_chord = Eight{} + 1.0F;
    for (int k = 0; k < 3; ++k) {
      const Eight closest =
          ball.camera_in_ball[k] + rays.depth_of_closest[i] * rays.direction[k][i];
      squared_half_chord -= closest * closest;
      points->mirror_image[k][i] = closest;
    }
    points->squared_half_chord[i] = squared_half_chord;
    SquareRoot(squared_half_chord * rays.inverse_squared[i], &points->half_chord[i]);
  }
  for (size_t i = 0; i < rays.squared.size(); ++i) {
    points->exist[i] = rays.depth_of_closest[i] > points->half_chord[i];
    for (int k = 0; k < 3; ++k) {
      const Eight point = points->mirror_image[k][i] - points->half_chord[i] * rays.direction[k][i];
      points->mirror_image[k][i] = k == 1 ? -point : point;
    }
  }
}

// With p the point in the ball, the normal is p / axes, and its dot product with a direction is
// that of p with the direction in the ball.
SOSLAM_FORCE_INLINE void FindVisible(const UnitBall& ball, const RaysInBall& rays,
                                     const PointsOnBall& points, float squared_cosine,
                                     MirroredBatch* mirrored) {
  const Eigen::Vector3f squared_inverse_axes = ball.squared_axes.cwiseInverse();
  for (size_t i = 0; i < rays.squared.size(); ++i) {
    Eight squared_normal{}, squared_to_camera{}, there = Eight{} - 1.0F;
    for (int k = 0; k < 3; ++k) {
      const Eight& point = points.mirror_image[k][i];
      const Eight to_camera = ball.camera_in_ball[k] - point;
      squared_normal += squared_inverse_axes[k] * (point * point);
      squared_to_camera += ball.squared_axes[k] * (to_camera * to_camera);
      there += point * ball.camera_in_ball[k];
    }
    const Eight least = squared_cosine * squared_normal;
    const EightMask is_seen =
        points.squared_half_chord[i] * rays.squared[i] >= least * rays.length_in_camera[i];
    const EightMask is_mirror_image_seen =
        (there >= 0.0F) & (there * there >= least * squared_to_camera);
    StoreOnes(points.exist[i], mirrored->is_on_surface.data() + 8 * i);
    StoreOnes(points.exist[i] & is_seen & is_mirror_image_seen,
              mirrored->is_visible.data() + 8 * i);
  }
}

SOSLAM_FORCE_INLINE void Project(const Eigen::Matrix<float, 3, 4>& image_from_ball,
                                 const ThreeEights& points, MirroredBatch* mirrored) {
  for (size_t i = 0; i < points[0].size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      Store(image_from_ball(k, 0) * points[0][i] + image_from_ball(k, 1) * points[1][i] +
                image_from_ball(k, 2) * points[2][i] + image_from_ball(k, 3),
            mirrored->in_image[k].data() + 8 * i);
    }
  }
}

// BodySurface::Meet and MirrorVisible for ellipsoids, in single precision. Each step runs over a
// whole batch: the roots and divisions of one ray depend on each other, those of different rays do
// not.
SOSLAM_MULTIVERSION void MirrorVisibleOnEllipsoid(const UnitBall& ball, const PixelRays& rays,
                                                  double min_viewing_cosine,
                                                  std::vector<MirroredBatch>* mirrored) {
  const UnitBall copy = ball;  // a local copy cannot overlap the output
  const auto squared_cosine = static_cast<float>(min_viewing_cosine * min_viewing_cosine);
  const double* x = rays.x.data();
  const double* y = rays.y.data();
  for (MirroredBatch& batch : *mirrored) {
    RaysInBall in_ball;
    PointsOnBall points;
    TurnToBall(copy, x, y, &in_ball);
    MeetBall(copy, in_ball, &points);
    FindVisible(copy, in_ball, points, squared_cosine, &batch);
    Project(copy.image_from_ball, points.mirror_image, &batch);
    x += kBatchSize;
    y += kBatchSize;
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
  // Every ray is written at the place of the next visible one, which advances only if it is
  // visible.
  ray.resize(num_rays);
  for (auto& coordinate : in_image) coordinate.resize(num_rays + kBatchSize);
  // Local copies of the pointers, as the compiler cannot rule out that the output overlaps the
  // members.
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
