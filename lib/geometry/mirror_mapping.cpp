// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mirror_mapping.h"

#include <cmath>

namespace soslam {

VisibleSurface::VisibleSurface(const Camera& camera, const Landmark& landmark_in_camera)
    : camera_(camera),
      camera_from_object_rotation_(
          landmark_in_camera.frame_from_object.rotation.toRotationMatrix()),
      centre_in_camera_(landmark_in_camera.Centre()),
      camera_in_object_(-(camera_from_object_rotation_.transpose() * centre_in_camera_)),
      inverse_squared_axes_(landmark_in_camera.half_axes.cwiseAbs2().cwiseInverse()) {}

Eigen::Vector3d VisibleSurface::RayInObject(const Eigen::Vector2d& pixel) const {
  return camera_from_object_rotation_.transpose() * camera_.Ray(pixel);
}

LandmarkJacobian3 VisibleSurface::FixedPointJacobian(const Eigen::Vector3d& point_in_object) const {
  // Turning R to exp(w) R takes R^T v to R^T (v - w x v), v = R point_in_object.
  LandmarkJacobian3 jacobian = LandmarkJacobian3::Zero();
  jacobian.leftCols<3>() = camera_from_object_rotation_.transpose() *
                           Skew(camera_from_object_rotation_ * point_in_object);
  jacobian.middleCols<3>(3) = -camera_from_object_rotation_.transpose();
  return jacobian;
}

std::optional<VisibleSurface::Point> VisibleSurface::FromPixel(const Eigen::Vector2d& pixel,
                                                               bool with_jacobian) const {
  const Eigen::Vector3d ray = RayInObject(pixel);
  const Eigen::Vector3d weighted_ray = inverse_squared_axes_.cwiseProduct(ray);
  const double a = ray.dot(weighted_ray);
  const double half_b = camera_in_object_.dot(weighted_ray);
  const double c = camera_in_object_.cwiseAbs2().dot(inverse_squared_axes_) - 1.0;
  const double discriminant = half_b * half_b - a * c;
  if (!(discriminant > 0.0) || !(c > 0.0) || !(half_b < 0.0)) return std::nullopt;
  const double depth = c / (-half_b + std::sqrt(discriminant));

  Point point;
  point.in_object = camera_in_object_ + depth * ray;
  if (with_jacobian) {
    // Theta(p) = sum p_i^2 / s_i^2 - 1 stays 0 while the depth along the ray gives way.
    const Eigen::Vector3d gradient = 2.0 * inverse_squared_axes_.cwiseProduct(point.in_object);
    point.jacobian = FixedPointJacobian(point.in_object);
    LandmarkJacobian1 theta = gradient.transpose() * point.jacobian;
    theta.tail<3>() -= gradient.cwiseProduct(point.in_object).transpose();
    point.jacobian -= ray * (theta / gradient.dot(ray));
  }
  return point;
}

std::optional<VisibleSurface::Point> VisibleSurface::FromPixelOnTangentPlane(
    const Eigen::Vector2d& pixel, const Point& contact, bool with_jacobian) const {
  const Eigen::Vector3d ray = RayInObject(pixel);
  const Eigen::Vector3d normal = inverse_squared_axes_.cwiseProduct(contact.in_object);
  const double slope = normal.dot(ray);
  const double depth = (1.0 - normal.dot(camera_in_object_)) / slope;
  if (!std::isfinite(depth) || !(depth > 0.0)) return std::nullopt;

  Point point;
  point.in_object = camera_in_object_ + depth * ray;
  if (with_jacobian) {
    // The plane sum p_i contact_i / s_i^2 = 1 moves with the contact point and the half axes.
    const Eigen::Vector3d weighted_point = inverse_squared_axes_.cwiseProduct(point.in_object);
    point.jacobian = FixedPointJacobian(point.in_object);
    LandmarkJacobian1 plane =
        normal.transpose() * point.jacobian + weighted_point.transpose() * contact.jacobian;
    plane.tail<3>() -= 2.0 * weighted_point.cwiseProduct(contact.in_object).transpose();
    point.jacobian -= ray * (plane / slope);
  }
  return point;
}

VisibleSurface::Point VisibleSurface::MirrorImage(const Point& point) const {
  Point mirrored = point;
  mirrored.in_object.y() = -mirrored.in_object.y();
  mirrored.jacobian.row(1) = -mirrored.jacobian.row(1);
  return mirrored;
}

std::optional<VisibleSurface::Pixel> VisibleSurface::ToPixel(const Point& point,
                                                             bool with_jacobian) const {
  const Eigen::Vector3d offset_in_camera = camera_from_object_rotation_ * point.in_object;
  const Eigen::Vector3d in_camera = offset_in_camera + centre_in_camera_;
  const auto projected = camera_.Project(in_camera);
  if (!projected) return std::nullopt;

  Pixel pixel;
  pixel.pixel = *projected;
  if (with_jacobian) {
    LandmarkJacobian3 motion = camera_from_object_rotation_ * point.jacobian;
    motion.leftCols<3>() -= Skew(offset_in_camera);
    motion.middleCols<3>(3) += Eigen::Matrix3d::Identity();
    const double inverse_depth = 1.0 / in_camera.z();
    Eigen::Matrix<double, 2, 3> projection;
    projection << camera_.fx, 0, -camera_.fx * in_camera.x() * inverse_depth,  //
        0, camera_.fy, -camera_.fy * in_camera.y() * inverse_depth;
    pixel.jacobian = inverse_depth * projection * motion;
  }
  return pixel;
}

double VisibleSurface::ViewingCosine(const Point& point) const {
  const Eigen::Vector3d normal = inverse_squared_axes_.cwiseProduct(point.in_object).normalized();
  return normal.dot((camera_in_object_ - point.in_object).normalized());
}

}  // namespace soslam
