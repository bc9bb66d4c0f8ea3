// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"
#include "soslam/image/edge_maps.h"

namespace soslam {

// A cuboid upright on a plane, its foot at that depth behind a pixel.
inline Landmark StandingCuboid(const Camera& camera, const Plane& plane_in_camera,
                               const Eigen::Vector2d& foot_pixel, double yaw,
                               const Eigen::Vector3d& half_axes) {
  const Eigen::Vector3d ray = camera.Ray(foot_pixel);
  const Eigen::Vector3d foot = -plane_in_camera.offset / plane_in_camera.normal.dot(ray) * ray;
  return {
      {UprightRotation(plane_in_camera.normal, yaw), foot + half_axes.z() * plane_in_camera.normal},
      half_axes,
      kCuboidExponent};
}

// Pixels are means over this many points each way: an image of pixels that are one face or the
// other would show bodies half a pixel larger than they are, since lines of a polygon belong to it.
inline constexpr int kSubpixels = 4;

// Fills the faces of a cuboid that the camera sees, each with a grey of its own.
inline void DrawVisibleFaces(const Camera& camera, const Landmark& landmark_in_camera,
                             cv::Mat* image) {
  constexpr int kFractionBits = 8;
  const auto to_image = [](double pixel) {
    const double in_image = kSubpixels * (pixel + 0.5) - 0.5;
    return static_cast<int>(std::lround(in_image * (1 << kFractionBits)));
  };
  const Eigen::Vector3d camera_in_unit_body =
      landmark_in_camera.frame_from_object.Inverse().translation.cwiseQuotient(
          landmark_in_camera.half_axes);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      if (!(sign * camera_in_unit_body[axis] > 1.0)) continue;
      std::vector<cv::Point> corners;
      for (const auto& [i, j] : {std::pair(-1.0, -1.0), {-1.0, 1.0}, {1.0, 1.0}, {1.0, -1.0}}) {
        Eigen::Vector3d corner;
        corner[axis] = sign;
        corner[(axis + 1) % 3] = i;
        corner[(axis + 2) % 3] = j;
        const auto pixel = camera.Project(landmark_in_camera.frame_from_object *
                                          landmark_in_camera.half_axes.cwiseProduct(corner));
        corners.emplace_back(to_image(pixel->x()), to_image(pixel->y()));
      }
      cv::fillConvexPoly(*image, corners, cv::Scalar(95 + 75 * axis), cv::LINE_8, kFractionBits);
    }
  }
}

// A dark image with the visible faces of cuboids in it, later ones before earlier ones: the edges
// in the image are the visible edges of the cuboids.
inline cv::Mat DrawCuboids(const Camera& camera, const std::vector<Landmark>& landmarks_in_camera) {
  cv::Mat fine(kSubpixels * camera.height, kSubpixels * camera.width, CV_8UC1, cv::Scalar(20));
  for (const Landmark& landmark : landmarks_in_camera) DrawVisibleFaces(camera, landmark, &fine);
  cv::Mat image;
  cv::resize(fine, image, cv::Size(camera.width, camera.height), 0.0, 0.0, cv::INTER_AREA);
  return image;
}

}  // namespace soslam
