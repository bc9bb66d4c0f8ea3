// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/mirror_mapping.h"

#include <cmath>

namespace soslam {

VisibleSurface::VisibleSurface(const Camera& camera, const Landmark& landmark_in_camera)
    : camera_(camera),
      camera_from_object_rotation_(
          landmark_in_camera.frame_from_object.rotation.toRotationMatrix()),
      centre_in_camera_(landmark_in_camera.Centre()),
      camera_in_object_(-(camera_from_object_rotation_.transpose() * centre_in_camera_)),
      image_from_object_rotation_(camera.Intrinsics() * camera_from_object_rotation_),
      centre_pixel_times_depth_(camera.Intrinsics() * centre_in_camera_),
      surface_(landmark_in_camera.half_axes, landmark_in_camera.shape_exponents),
      size_(MeanHalfAxis(landmark_in_camera)) {}

Eigen::Vector3d VisibleSurface::RayInObject(const Eigen::Vector2d& pixel) const {
  return camera_from_object_rotation_.transpose() * camera_.Ray(pixel);
}

std::optional<VisibleSurface::Point> VisibleSurface::FromPixel(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector3d ray = RayInObject(pixel);
  const auto depth = surface_.Entry(camera_in_object_, ray);
  if (!depth) return std::nullopt;
  return Point{camera_in_object_ + *depth * ray};
}

std::optional<Eigen::Vector3d> VisibleSurface::FromPixelOnTangentPlane(const Eigen::Vector2d& pixel,
                                                                       const Point& tangent) const {
  const Eigen::Vector3d ray = RayInObject(pixel);
  const Eigen::Vector3d normal = surface_.Gradient(tangent.in_object);
  const double depth = (1.0 - normal.dot(camera_in_object_)) / normal.dot(ray);
  if (!std::isfinite(depth) || !(depth > 0.0)) return std::nullopt;
  return camera_in_object_ + depth * ray;
}

VisibleSurface::Point VisibleSurface::MirrorImage(const Point& point, double mirror_plane) const {
  const double shift = 2.0 * mirror_plane * size_;
  const Eigen::Vector3d& x = point.in_object;
  return {{x.x(), shift - x.y(), x.z()}, -point.y_sign, shift - point.y_shift_m};
}

VisibleSurface::MirrorLine VisibleSurface::MirrorImages(const Point& point) const {
  const Eigen::Vector3d mirrored = point.in_object.cwiseProduct(Eigen::Vector3d(1, -1, 1));
  return {image_from_object_rotation_ * mirrored + centre_pixel_times_depth_,
          2.0 * size_ * image_from_object_rotation_.col(1)};
}

std::optional<Eigen::Vector2d> VisibleSurface::ToPixel(const Point& point) const {
  return camera_.Project(camera_from_object_rotation_ * point.in_object + centre_in_camera_);
}

LandmarkJacobian1 VisibleSurface::FixedPointDerivative(const Eigen::Vector3d& point_in_object,
                                                       const Eigen::Vector3d& direction) const {
  // R replaced by exp(w) R changes R^T v to R^T (v - w x v), v = R point_in_object.
  const Eigen::Vector3d in_camera = camera_from_object_rotation_ * direction;
  LandmarkJacobian1 derivative = LandmarkJacobian1::Zero();
  derivative.head<3>() = in_camera.cross(camera_from_object_rotation_ * point_in_object);
  derivative.segment<3>(3) = -in_camera;
  return derivative;
}

LandmarkJacobian1 VisibleSurface::Derivative(const Point& point,
                                             const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d mirror(1.0, point.y_sign, 1.0);
  const Eigen::Vector3d x =
      mirror.cwiseProduct(point.in_object - point.y_shift_m * Eigen::Vector3d::UnitY());
  const Eigen::Vector3d along = mirror.cwiseProduct(direction);
  // Implicit derivative: the depth along the ray changes such that F = 1 still holds.
  const Eigen::Vector3d ray = x - camera_in_object_;
  const Eigen::Vector3d gradient = surface_.Gradient(x);
  const double by_depth = along.dot(ray) / gradient.dot(ray);
  LandmarkJacobian1 derivative = FixedPointDerivative(x, along - by_depth * gradient);
  derivative.tail<3>() += by_depth * gradient.cwiseProduct(x).transpose();
  derivative.tail<3>().array() += direction.y() * point.y_shift_m / 3.0;
  return derivative;
}

LandmarkJacobian1 VisibleSurface::DerivativeOnTangentPlane(const Eigen::Vector3d& in_object,
                                                           const Point& tangent,
                                                           const Eigen::Vector3d& direction) const {
  // The plane normal . x = 1 moves with the tangent point and the half axes.
  const Eigen::Vector3d ray = in_object - camera_in_object_;
  const Eigen::Vector3d normal = surface_.Gradient(tangent.in_object);
  const Eigen::Vector3d d_normal = surface_.Hessian(tangent.in_object) * in_object;
  const double by_depth = direction.dot(ray) / normal.dot(ray);
  LandmarkJacobian1 derivative = FixedPointDerivative(in_object, direction - by_depth * normal) -
                                 by_depth * Derivative(tangent, d_normal);
  derivative.tail<3>() +=
      by_depth *
      (normal.cwiseProduct(in_object) + d_normal.cwiseProduct(tangent.in_object)).transpose();
  return derivative;
}

LandmarkJacobian1 VisibleSurface::PixelDerivative(const Point& point,
                                                  const Eigen::Vector2d& direction) const {
  const Eigen::Vector3d from_centre = camera_from_object_rotation_ * point.in_object;
  const Eigen::Vector3d in_camera =
      camera_.ProjectionJacobian(from_centre + centre_in_camera_).transpose() * direction;
  LandmarkJacobian1 derivative =
      Derivative(point, camera_from_object_rotation_.transpose() * in_camera);
  derivative.head<3>() += from_centre.cross(in_camera).transpose();
  derivative.segment<3>(3) += in_camera.transpose();
  return derivative;
}

bool VisibleSurface::AreSeen(const Point& point, double min_viewing_cosine) const {
  const Eigen::Vector3d mirror(1, -1, 1);
  const Eigen::Vector3d normal = surface_.Gradient(point.in_object);
  const double least = min_viewing_cosine * normal.norm();
  const auto is_seen = [&](const Eigen::Vector3d& in_object, const Eigen::Vector3d& outward) {
    const Eigen::Vector3d to_camera = camera_in_object_ - in_object;
    return outward.dot(to_camera) >= least * to_camera.norm();
  };
  return is_seen(point.in_object, normal) &&
         is_seen(point.in_object.cwiseProduct(mirror), normal.cwiseProduct(mirror));
}

}  // namespace soslam
