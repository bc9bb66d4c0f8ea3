// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/landmark.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>

#include "soslam/geometry/surface.h"

namespace soslam {

Eigen::Matrix3d OwnFromObject(RestingFace face) {
  Eigen::Matrix3d own_from_object = Eigen::Matrix3d::Identity();
  if (face == RestingFace::kBack) {
    own_from_object << 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0;
  } else if (face == RestingFace::kSide) {
    own_from_object << 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0;
  }
  return own_from_object;
}

Eigen::Vector3d HalfAxesOnFace(const Eigen::Vector3d& own_half_axes, RestingFace face) {
  return OwnFromObject(face).cwiseAbs().transpose() * own_half_axes;
}

namespace {

// A unit vector orthogonal to the normal: the projection of x, or of y where x is nearly parallel
// to the normal.
Eigen::Vector3d HorizontalReference(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d seed =
      std::abs(normal.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  return (seed - normal * normal.dot(seed)).normalized();
}

constexpr double kSettledStepPx = 1e-6;  // the error after such a step of Newton's is near rounding
constexpr int kMaxOutlineSteps = 50;

}  // namespace

double MeanHalfAxis(const Landmark& landmark) { return std::cbrt(landmark.half_axes.prod()); }

Landmark Transform(const Rigid3d& target_from_source, const Landmark& landmark_in_source) {
  Landmark landmark_in_target = landmark_in_source;
  landmark_in_target.frame_from_object = target_from_source * landmark_in_source.frame_from_object;
  return landmark_in_target;
}

Landmark InOwnAxes(const Landmark& landmark) {
  if (landmark.rests_on == RestingFace::kBottom) return landmark;
  const Eigen::Matrix3d own_from_object = OwnFromObject(landmark.rests_on);
  Landmark own = landmark;
  own.frame_from_object.rotation =
      (landmark.frame_from_object.rotation * Eigen::Quaterniond(own_from_object).conjugate())
          .normalized();
  own.half_axes = own_from_object.cwiseAbs() * landmark.half_axes;
  own.shape_exponents = landmark.shape_exponents.Mean();
  own.rests_on = RestingFace::kBottom;
  return own;
}

Eigen::Matrix4d DualQuadric(const Landmark& landmark) {
  const Eigen::Matrix4d pose = landmark.frame_from_object.Matrix();
  Eigen::Vector4d diagonal;
  diagonal << landmark.half_axes.cwiseAbs2(), -1.0;
  return pose * diagonal.asDiagonal() * pose.transpose();
}

std::optional<DualQuadricLandmark> LandmarkFromDualQuadric(const Eigen::Matrix4d& dual_quadric) {
  if (!dual_quadric.allFinite() || dual_quadric(3, 3) == 0.0) return std::nullopt;
  const Eigen::Matrix4d scaled = dual_quadric / -dual_quadric(3, 3);
  const Eigen::Vector3d centre = -scaled.topRightCorner<3, 1>();
  const Eigen::Matrix3d centred = scaled.topLeftCorner<3, 3>() + centre * centre.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 * (centred + centred.transpose()));
  if (eigen.info() != Eigen::Success) return std::nullopt;
  Eigen::Matrix3d axes = eigen.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);

  DualQuadricLandmark result;
  result.proper = eigen.eigenvalues().minCoeff() > 0.0;
  result.landmark.frame_from_object = {Eigen::Quaterniond(axes).normalized(), centre};
  result.landmark.half_axes = eigen.eigenvalues().cwiseAbs().cwiseSqrt();
  const bool usable = centre.allFinite() && result.landmark.half_axes.allFinite() &&
                      result.landmark.half_axes.minCoeff() > 0.0;
  return usable ? std::optional(result) : std::nullopt;
}

SupportPoint FindSupportPoint(const Landmark& landmark, const Eigen::Vector3d& direction) {
  const Eigen::Quaterniond& rotation = landmark.frame_from_object.rotation;
  const SupportValue support = SupportFunction(landmark.half_axes, landmark.shape_exponents,
                                               rotation.conjugate() * direction);
  return {landmark.frame_from_object * support.point,
          direction.dot(landmark.Centre()) + support.extent};
}

Plane ComputeSupportPlane(const Landmark& landmark) {
  const Eigen::Vector3d up = landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
  return {up, landmark.half_axes.z() - up.dot(landmark.Centre())};
}

bool HasExtent(const Landmark& landmark) {
  return landmark.Centre().allFinite() &&
         landmark.frame_from_object.rotation.coeffs().allFinite() &&
         landmark.half_axes.allFinite() && landmark.half_axes.minCoeff() > 0.0;
}

bool IsInFront(const Landmark& landmark_in_camera) {
  return FindSupportPoint(landmark_in_camera, -Eigen::Vector3d::UnitZ()).extent < 0.0;
}

std::optional<SilhouettePoint> FindSilhouettePoint(const Camera& camera,
                                                   const Landmark& landmark_in_camera,
                                                   const Eigen::Vector2d& direction,
                                                   const Eigen::Vector3d& start) {
  const Eigen::Vector3d line(direction.x(), direction.y(), 0.0);
  return FindSilhouettePoint(camera.Intrinsics().transpose() * line, landmark_in_camera, start);
}

std::optional<SilhouettePoint> FindSilhouettePoint(const Eigen::Vector3d& plane,
                                                   const Landmark& landmark_in_camera,
                                                   const Eigen::Vector3d& start) {
  // All points of the body project inside its silhouette. The support point for the plane through
  // the camera centre and a line parallel to l projects beyond that line, until the plane is
  // tangent: Newton's method for a convex function of the line's distance from l.
  SilhouettePoint outline{start, -std::numeric_limits<double>::infinity()};
  for (int i = 0; i < kMaxOutlineSteps; ++i) {
    if (!(outline.point.z() > 0.0)) return std::nullopt;
    const double end_px = plane.dot(outline.point) / outline.point.z();
    const bool settled = std::abs(end_px - outline.end_px) < kSettledStepPx;
    outline.end_px = end_px;
    if (settled) break;
    const Eigen::Vector3d parallel = plane - end_px * Eigen::Vector3d::UnitZ();
    outline.point = FindSupportPoint(landmark_in_camera, parallel).point;
  }
  return outline;
}

std::optional<Box> OutlineBox(const Camera& camera, const Landmark& landmark_in_camera) {
  if (!IsInFront(landmark_in_camera)) return std::nullopt;
  std::array<double, 4> ends{};
  for (size_t i = 0; i < ends.size(); ++i) {
    const double sign = i < 2 ? -1.0 : 1.0;
    const Eigen::Vector2d direction =
        i % 2 == 0 ? Eigen::Vector2d(sign, 0.0) : Eigen::Vector2d(0.0, sign);
    const auto end =
        FindSilhouettePoint(camera, landmark_in_camera, direction, landmark_in_camera.Centre());
    if (!end) return std::nullopt;
    ends[i] = sign * end->end_px;
  }
  return Box{ends[0], ends[1], ends[2], ends[3]};
}

double OutlineEdgeRms(const Camera& camera, const Landmark& landmark_in_camera, const Box& box) {
  const auto outline = OutlineBox(camera, landmark_in_camera);
  if (!outline) return std::numeric_limits<double>::infinity();
  const Eigen::Vector4d difference(outline->x_min - box.x_min, outline->y_min - box.y_min,
                                   outline->x_max - box.x_max, outline->y_max - box.y_max);
  return 0.5 * difference.norm();
}

std::optional<double> NearestIntersection(const Landmark& landmark, const Eigen::Vector3d& origin,
                                          const Eigen::Vector3d& direction) {
  const Eigen::Quaterniond object_from_frame = landmark.frame_from_object.rotation.conjugate();
  return BodySurface(landmark.half_axes, landmark.shape_exponents)
      .Entry(object_from_frame * (origin - landmark.Centre()), object_from_frame * direction);
}

Eigen::Quaterniond UprightRotation(const Eigen::Vector3d& support_normal, double yaw) {
  const Eigen::Vector3d reference = HorizontalReference(support_normal);
  Eigen::Matrix3d axes;
  axes.col(0) = reference;
  axes.col(1) = support_normal.cross(reference);
  axes.col(2) = support_normal;
  return (Eigen::Quaterniond(axes) *
          Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())))
      .normalized();
}

double Yaw(const Eigen::Vector3d& support_normal, const Eigen::Quaterniond& frame_from_object) {
  const Eigen::Vector3d reference = HorizontalReference(support_normal);
  const Eigen::Vector3d front = frame_from_object * Eigen::Vector3d::UnitX();
  return std::atan2(front.dot(support_normal.cross(reference)), front.dot(reference));
}

Eigen::RowVector3d YawJacobian(const Eigen::Vector3d& support_normal,
                               const Eigen::Quaterniond& frame_from_object) {
  const Eigen::Vector3d front = frame_from_object * Eigen::Vector3d::UnitX();
  const double rise = front.dot(support_normal);
  const Eigen::Vector3d level = front - rise * support_normal;
  return (support_normal - rise / level.squaredNorm() * level).transpose();
}

Landmark RotatedAboutZ(const Landmark& landmark, double angle) {
  Landmark turned = landmark;
  turned.frame_from_object.rotation =
      (landmark.frame_from_object.rotation *
       Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())))
          .normalized();
  return turned;
}

double YawDifferenceModuloPi(double yaw, double other) {
  constexpr double kPi = std::numbers::pi;
  const double difference = std::fmod(yaw - other + 0.5 * kPi, kPi);
  return (difference < 0.0 ? difference + kPi : difference) - 0.5 * kPi;
}

Landmark ApplyStep(const Landmark& landmark, const LandmarkStep& step) {
  Landmark moved = landmark;
  moved.frame_from_object.rotation =
      (ExpRotation(step.head<3>()) * landmark.frame_from_object.rotation).normalized();
  moved.frame_from_object.translation += step.segment<3>(3);
  moved.half_axes = landmark.half_axes.array() * step.tail<3>().array().exp();
  return moved;
}

}  // namespace soslam
