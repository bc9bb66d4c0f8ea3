// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/surface.h"

namespace soslam {

// A landmark seen from a camera, prepared for many rays: P-dagger of eq. (13), its tangent-plane
// approximation, and the mirror image of eq. (14). Points are in the object frame, where the mirror
// plane is y = 0. A camera inside the body sees nothing of it.
class VisibleSurface {
 public:
  // A point of the surface on a pixel's ray, or its mirror image.
  struct Point {
    Eigen::Vector3d in_object;
    // y is y_sign times that of the point on the ray, plus y_shift_m.
    double y_sign = 1.0;  // -1 for a mirror image
    double y_shift_m = 0.0;

    bool IsOnRay() const { return y_sign == 1.0 && y_shift_m == 0.0; }
  };

  VisibleSurface(const Camera& camera, const Landmark& landmark_in_camera);

  // P-dagger, eq. (13): the nearer intersection of the pixel's ray with the surface. None when the
  // ray misses the surface.
  std::optional<Point> FromPixel(const Eigen::Vector2d& pixel) const;

  // The intersection of the pixel's ray with the plane that is tangent to the surface at `tangent`,
  // a surface point (eq. 23). None when the ray is parallel to the plane or meets it behind the
  // camera.
  std::optional<Eigen::Vector3d> FromPixelOnTangentPlane(const Eigen::Vector2d& pixel,
                                                         const Point& tangent) const;

  // S, the mirror image in the xz plane; again a surface point. With another `mirror_plane`, in the
  // plane y = mirror_plane * MeanHalfAxis: the image is then near the surface where that is flat,
  // and may lie beside the body.
  Point MirrorImage(const Point& point, double mirror_plane = 0.0) const;

  // The mirror image of a point in homogeneous pixels, K times its position in the camera:
  // `at_zero` + mirror_plane * `by_plane`.
  struct MirrorLine {
    Eigen::Vector3d at_zero;
    Eigen::Vector3d by_plane;
  };
  MirrorLine MirrorImages(const Point& point) const;

  // P: the projection of a point to its pixel, visible or not. None behind the camera.
  std::optional<Eigen::Vector2d> ToPixel(const Point& point) const;

  // d (direction . point) / d landmark, for a point of a fixed pixel or its mirror image.
  LandmarkJacobian1 Derivative(const Point& point, const Eigen::Vector3d& direction) const;
  // Derivative of what FromPixelOnTangentPlane gives; `tangent` moves with the landmark.
  LandmarkJacobian1 DerivativeOnTangentPlane(const Eigen::Vector3d& in_object, const Point& tangent,
                                             const Eigen::Vector3d& direction) const;
  // d (direction . ToPixel) / d landmark; zero for a point on its pixel's ray.
  LandmarkJacobian1 PixelDerivative(const Point& point, const Eigen::Vector2d& direction) const;

  // True if the cosine between the outward normal and the direction to the camera is at least this
  // at a surface point and at its mirror image; it is 0 on the outline.
  bool AreSeen(const Point& point, double min_viewing_cosine) const;

 private:
  Eigen::Vector3d RayInObject(const Eigen::Vector2d& pixel) const;
  // The derivative of `direction` . R^T (x - t) for a point x fixed in the camera frame.
  LandmarkJacobian1 FixedPointDerivative(const Eigen::Vector3d& point_in_object,
                                         const Eigen::Vector3d& direction) const;

  Camera camera_;
  Eigen::Matrix3d camera_from_object_rotation_;
  Eigen::Vector3d centre_in_camera_;
  Eigen::Vector3d camera_in_object_;
  Eigen::Matrix3d image_from_object_rotation_;  // K R
  Eigen::Vector3d centre_pixel_times_depth_;    // K t
  BodySurface surface_;
  double size_;
};

}  // namespace soslam
