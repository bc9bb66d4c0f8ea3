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
      image_from_object_rotation_(camera.Intrinsics() * camera_from_object_rotation_),
      centre_in_image_(camera.Intrinsics() * centre_in_camera_),
      surface_(landmark_in_camera.half_axes, landmark_in_camera.shape_exponents),
      size_(MeanHalfAxis(landmark_in_camera)) {}

Eigen::Vector3d VisibleSurface::RayInObject(const Eigen::Vector2d& pixel) const {
  return camera_from_object_rotation_.transpose() * camera_.Ray(pixel);
}

LandmarkJacobian3 VisibleSurface::FixedPointJacobian(const Eigen::Vector3d& point_in_object) const {
  // R replaced by exp(w) R changes R^T v to R^T (v - w x v), v = R point_in_object.
  LandmarkJacobian3 jacobian = LandmarkJacobian3::Zero();
  jacobian.leftCols<3>() = camera_from_object_rotation_.transpose() *
                           Skew(camera_from_object_rotation_ * point_in_object);
  jacobian.middleCols<3>(3) = -camera_from_object_rotation_.transpose();
  return jacobian;
}

std::optional<VisibleSurface::Point> VisibleSurface::FromPixel(const Eigen::Vector2d& pixel,
                                                               bool with_jacobian) const {
  const Eigen::Vector3d ray = RayInObject(pixel);
  const auto depth = surface_.Entry(camera_in_object_, ray);
  if (!depth) return std::nullopt;

  Point point;
  point.in_object = camera_in_object_ + *depth * ray;
  if (with_jacobian) {
    // Implicit derivative: the depth along the ray changes such that F = 1 still holds.
    const Eigen::Vector3d gradient = surface_.Gradient(point.in_object);
    point.jacobian = FixedPointJacobian(point.in_object);
    LandmarkJacobian1 change = gradient.transpose() * point.jacobian;
    change.tail<3>() -= gradient.cwiseProduct(point.in_object).transpose();
    point.jacobian -= ray * (change / gradient.dot(ray));
  }
  return point;
}

std::optional<VisibleSurface::Point> VisibleSurface::FromPixelOnTangentPlane(
    const Eigen::Vector2d& pixel, const Point& tangent, bool with_jacobian) const {
  const Eigen::Vector3d ray = RayInObject(pixel);
  const Eigen::Vector3d normal = surface_.Gradient(tangent.in_object);
  const double slope = normal.dot(ray);
  const double depth = (1.0 - normal.dot(camera_in_object_)) / slope;
  if (!std::isfinite(depth) || !(depth > 0.0)) return std::nullopt;

  Point point;
  point.in_object = camera_in_object_ + depth * ray;
  if (with_jacobian) {
    // The plane normal . x = 1 moves with the tangent point and the half axes.
    const Eigen::Vector3d d_normal = surface_.Hessian(tangent.in_object) * point.in_object;
    point.jacobian = FixedPointJacobian(point.in_object);
    LandmarkJacobian1 plane =
        normal.transpose() * point.jacobian + d_normal.transpose() * tangent.jacobian;
    plane.tail<3>() -=
        (normal.cwiseProduct(point.in_object) + d_normal.cwiseProduct(tangent.in_object))
            .transpose();
    point.jacobian -= ray * (plane / slope);
  }
  return point;
}

VisibleSurface::Point VisibleSurface::MirrorImage(const Point& point, double mirror_plane) const {
  const double shift = 2.0 * mirror_plane * size_;
  Point mirrored = point;
  mirrored.in_object.y() = shift - mirrored.in_object.y();
  mirrored.jacobian.row(1) = -mirrored.jacobian.row(1);
  mirrored.jacobian.row(1).tail<3>().array() += shift / 3.0;
  return mirrored;
}

VisibleSurface::MirrorLine VisibleSurface::MirrorImages(const Point& point) const {
  const Eigen::Vector3d mirrored = point.in_object.cwiseProduct(Eigen::Vector3d(1, -1, 1));
  return {image_from_object_rotation_ * mirrored + centre_in_image_,
          2.0 * size_ * image_from_object_rotation_.col(1)};
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
    pixel.jacobian = camera_.ProjectionJacobian(in_camera) * motion;
  }
  return pixel;
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
