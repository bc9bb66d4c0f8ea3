// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "soslam/geometry/image_size.h"
#include "soslam/geometry/plane.h"
#include "soslam/geometry/rigid3.h"

namespace soslam {

// A pinhole camera without distortion. Camera frame: x right, y down, z forward. Pixels, (0, 0) the
// centre of the top-left pixel.
struct Camera {
  int width = 0;
  int height = 0;
  double fx = 1.0;
  double fy = 1.0;
  double cx = 0.0;
  double cy = 0.0;

  bool operator==(const Camera&) const = default;

  // The pixel of a point; none when the point is not in front of the camera (z <= 0).
  std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& point_in_camera) const {
    if (!(point_in_camera.z() > 0.0)) return std::nullopt;
    return Eigen::Vector2d(fx * point_in_camera.x() / point_in_camera.z() + cx,
                           fy * point_in_camera.y() / point_in_camera.z() + cy);
  }
  // d pixel / d point of Project, for a point in front of the camera.
  Eigen::Matrix<double, 2, 3> ProjectionJacobian(const Eigen::Vector3d& point_in_camera) const;
  // The viewing ray of a pixel, with z = 1: (point at depth z) = z * ray.
  Eigen::Vector3d Ray(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy, 1.0};
  }
  // K, 3 x 3.
  Eigen::Matrix3d Intrinsics() const;
  // The plane through the camera centre and an image line, eq. (2) with P = K [I | 0]: K^T l,
  // normalised. In the camera frame; its offset is 0.
  Plane BackProject(const Eigen::Vector3d& line) const;
  bool IsInside(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= -0.5 && pixel.x() <= width - 0.5 && pixel.y() >= -0.5 &&
           pixel.y() <= height - 0.5;
  }
};

// The fault of the size of the images, in words; empty if it is an IsImageSize.
std::string TooLargeImage(const Camera& camera);

template <typename Visitor>
void Describe(Visitor& visit, Camera& camera) {
  visit.Field("width", &camera.width, "pixels", kAtLeastOne);
  visit.Field("height", &camera.height, "pixels", kAtLeastOne);
  visit.Field("fx", &camera.fx, "focal length along x, pixels", kPositive);
  visit.Field("fy", &camera.fy, "focal length along y, pixels", kPositive);
  visit.Field("cx", &camera.cx, "principal point, pixels");
  visit.Field("cy", &camera.cy, "principal point, pixels");
  visit.Check([&] { return TooLargeImage(camera); });
}

}  // namespace soslam
