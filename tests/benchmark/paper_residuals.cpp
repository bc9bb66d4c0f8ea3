// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/paper_residuals.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace soslam::paper {
namespace {

constexpr int kMaxCorners = 150;
constexpr int kUniformColumns = 8;
constexpr double kMinViewingCosine = 0.4;

Eigen::Matrix3d Rotation(const double* rotation_vector) {
  const Eigen::Map<const Eigen::Vector3d> vector(rotation_vector);
  const double angle = vector.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity() + Skew(vector);
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

Eigen::Matrix4d Rigid(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = rotation;
  matrix.topRightCorner<3, 1>() = translation;
  return matrix;
}

// What a pair costs whose points are no longer both on the surface: as much as the body is large.
double LostPair(const Landmark& start) { return start.half_axes.maxCoeff(); }

}  // namespace

Ellipsoid::Ellipsoid(const Landmark& start, const double* parameters)
    : rotation(Rotation(parameters) * start.frame_from_object.rotation.toRotationMatrix()),
      centre(start.Centre() + Eigen::Map<const Eigen::Vector3d>(parameters + 3)),
      half_axes(start.half_axes + Eigen::Map<const Eigen::Vector3d>(parameters + 6)) {}

Eigen::Matrix4d Ellipsoid::DualQuadric() const {
  const Eigen::Matrix4d world_from_object = Rigid(rotation, centre);
  Eigen::Vector4d diagonal;
  diagonal << half_axes.cwiseAbs2(), -1.0;
  return world_from_object * diagonal.asDiagonal() * world_from_object.transpose();
}

Eigen::Matrix4d CameraFromWorld(const Rigid3d& start, const double* parameters) {
  const Eigen::Matrix3d rotation = Rotation(parameters) * start.rotation.toRotationMatrix();
  const Eigen::Vector3d translation =
      start.translation + Eigen::Map<const Eigen::Vector3d>(parameters + 3);
  return Rigid(rotation.transpose(), -rotation.transpose() * translation);
}

bool DetectionResiduals::operator()(const double* pose, const double* landmark,
                                    double* residuals) const {
  const Eigen::Matrix4d dual_quadric = Ellipsoid(start, landmark).DualQuadric();
  const Eigen::Matrix<double, 3, 4> projection =
      camera.Intrinsics() * CameraFromWorld(view.world_from_camera, pose).topRows<3>();
  const auto lines = view.box.EdgeLines();
  for (size_t i = 0; i < lines.size(); ++i) {
    Eigen::Vector4d plane = projection.transpose() * lines[i];
    plane /= plane.head<3>().norm();
    residuals[i] = weight * plane.dot(dual_quadric * plane);
  }
  return true;
}

bool PriorResiduals::operator()(const double* landmark, double* residuals) const {
  const Ellipsoid ellipsoid(start, landmark);
  const Eigen::Vector4d support = plane.Homogeneous();
  residuals[0] = angle_weight * ellipsoid.rotation.col(0).dot(plane.normal);
  residuals[1] = angle_weight * ellipsoid.rotation.col(1).dot(plane.normal);
  residuals[2] = tangency_weight * support.dot(ellipsoid.DualQuadric() * support);
  residuals[3] = ellipsoid.half_axes.x() / ellipsoid.half_axes.z() - ratio.x();
  residuals[4] = ellipsoid.half_axes.y() / ellipsoid.half_axes.z() - ratio.y();
  return true;
}

bool OdometryResiduals::operator()(const double* first, const double* second,
                                   double* residuals) const {
  const Eigen::Matrix4d measured = (first_start.Inverse() * second_start).Matrix();
  const Eigen::Matrix4d estimated =
      CameraFromWorld(first_start, first) * CameraFromWorld(second_start, second).inverse();
  const Eigen::Matrix3d error =
      measured.topLeftCorner<3, 3>().transpose() * estimated.topLeftCorner<3, 3>();
  const Eigen::AngleAxisd turn(error);
  Eigen::Map<Eigen::Vector3d> rotation(residuals);
  Eigen::Map<Eigen::Vector3d> translation(residuals + 3);
  rotation = rotation_weight * turn.angle() * turn.axis();
  translation = translation_weight * (estimated - measured).topRightCorner<3, 1>();
  return true;
}

SymmetryResiduals::SymmetryResiduals(const Camera& camera, const View& view, const Landmark& start,
                                     double weight)
    : camera_(camera), view_(view), start_(start), weight_(weight) {
  const double none[kLandmarkSize] = {};
  const Surface surface = SurfaceAt(none, none);
  const auto add = [&](const Eigen::Vector2d& pixel) {
    const auto point = PointOf(surface, pixel);
    if (point && IsVisible(surface, *point) && IsVisible(surface, Mirrored(surface, *point)) &&
        Difference(surface, pixel)) {
      pixels_.push_back(pixel);
    }
  };
  const Box& box = view.box;
  int corners = 0;
  for (const Eigen::Vector2f& corner : view.edge_maps->corners) {
    if (corners == kMaxCorners) break;
    if (!box.Contains(corner.cast<double>())) continue;
    ++corners;
    add(corner.cast<double>());
  }
  for (int i = 0; i < kUniformColumns * kUniformColumns; ++i) {
    const double column = (i % kUniformColumns + 0.5) / kUniformColumns;
    const double row = (i / kUniformColumns + 0.5) / kUniformColumns;
    add({box.x_min + column * box.Width(), box.y_min + row * box.Height()});
  }
}

bool SymmetryResiduals::operator()(double const* const* blocks, double* residuals) const {
  const Surface surface = SurfaceAt(blocks[0], blocks[1]);
  const double lost = LostPair(start_);
  for (size_t i = 0; i < pixels_.size(); ++i) {
    residuals[i] = weight_ * Difference(surface, pixels_[i]).value_or(lost);
  }
  return true;
}

SymmetryResiduals::Surface SymmetryResiduals::SurfaceAt(const double* pose,
                                                        const double* landmark) const {
  const Ellipsoid ellipsoid(start_, landmark);
  const Eigen::Matrix4d camera_from_world = CameraFromWorld(view_.world_from_camera, pose);
  const Eigen::Matrix4d dual_quadric =
      camera_from_world * ellipsoid.DualQuadric() * camera_from_world.transpose();
  return {dual_quadric.inverse(), (camera_from_world * ellipsoid.centre.homogeneous()).head<3>(),
          camera_from_world.topLeftCorner<3, 3>() * ellipsoid.rotation.col(1)};
}

std::optional<Eigen::Vector3d> SymmetryResiduals::PointOf(const Surface& surface,
                                                          const Eigen::Vector2d& pixel) const {
  // The ray through the camera centre, in (13.b): a depth^2 + 2 b depth + c = 0.
  const Eigen::Vector3d ray = camera_.Ray(pixel);
  const double a = ray.dot(surface.quadric.topLeftCorner<3, 3>() * ray);
  const double b = ray.dot(surface.quadric.topRightCorner<3, 1>());
  const double c = surface.quadric(3, 3);
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0.0)) return std::nullopt;
  const double depth = (-b - std::sqrt(discriminant)) / a;
  const double other = (-b + std::sqrt(discriminant)) / a;
  const double nearer = std::min(depth, other);
  if (!(nearer > 0.0)) return std::nullopt;
  return nearer * ray;
}

Eigen::Vector3d SymmetryResiduals::Mirrored(const Surface& surface, const Eigen::Vector3d& point) {
  return point - 2.0 * surface.mirror_normal.dot(point - surface.centre) * surface.mirror_normal;
}

bool SymmetryResiduals::IsVisible(const Surface& surface, const Eigen::Vector3d& point) const {
  // Q v is the tangent plane; its sign is that of Q.
  Eigen::Vector3d normal = (surface.quadric * point.homogeneous()).head<3>().normalized();
  if (normal.dot(point - surface.centre) < 0.0) normal = -normal;
  return normal.dot(-point.normalized()) >= kMinViewingCosine;
}

std::optional<double> SymmetryResiduals::Descriptor(const Surface& surface,
                                                    const Eigen::Vector2d& pixel,
                                                    const Eigen::Vector3d& point) const {
  if (!camera_.IsInside(pixel)) return std::nullopt;
  const cv::Vec2s edge = view_.edge_maps->nearest_edge.at<cv::Vec2s>(
      static_cast<int>(std::floor(pixel.y() + 0.5)), static_cast<int>(std::floor(pixel.x() + 0.5)));
  if (edge[0] < 0) return std::nullopt;
  const Eigen::Vector3d ray = camera_.Ray({edge[0], edge[1]});
  const Eigen::Vector4d tangent_plane = surface.quadric * point.homogeneous();
  const double depth = -tangent_plane.w() / tangent_plane.head<3>().dot(ray);
  if (!std::isfinite(depth)) return std::nullopt;
  return (depth * ray - point).norm();
}

std::optional<double> SymmetryResiduals::Difference(const Surface& surface,
                                                    const Eigen::Vector2d& pixel) const {
  const auto point = PointOf(surface, pixel);
  if (!point) return std::nullopt;
  const Eigen::Vector3d mirrored = Mirrored(surface, *point);
  const auto mirror_pixel = camera_.Project(mirrored);
  if (!mirror_pixel) return std::nullopt;
  const auto here = Descriptor(surface, pixel, *point);
  const auto there = Descriptor(surface, *mirror_pixel, mirrored);
  if (!here || !there) return std::nullopt;
  return *here - *there;
}

}  // namespace soslam::paper
