// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace soslam {
namespace {

constexpr int kOutlineDirections = 90;
constexpr double kOutlineTolerancePx = 0.5;
constexpr double kGridSpacingM = 0.5;
constexpr double kGridMarginM = 0.5;  // around the contact points

}  // namespace

Polygon OutlinePolygon(const Camera& camera, const Landmark& landmark_in_camera) {
  if (!IsInFront(landmark_in_camera)) return {};
  std::vector<cv::Point2f> touched;
  const auto touch = [&](const Eigen::Vector3d& point_in_camera) {
    const auto pixel = camera.Project(point_in_camera);
    if (pixel) touched.emplace_back(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()));
  };
  if (landmark_in_camera.shape_exponent == kCuboidExponent) {
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d signs(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      touch(landmark_in_camera.frame_from_object *
            Eigen::Vector3d(signs.cwiseProduct(landmark_in_camera.half_axes)));
    }
  } else {
    Eigen::Vector3d last = landmark_in_camera.Centre();
    for (int i = 0; i < kOutlineDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kOutlineDirections;
      const auto end =
          FindSilhouettePoint(camera, landmark_in_camera, {std::cos(angle), std::sin(angle)}, last);
      if (!end) continue;
      last = end->point;
      touch(last);
    }
  }
  std::vector<cv::Point2f> hull, simple;
  cv::convexHull(touched, hull);
  cv::approxPolyDP(hull, simple, kOutlineTolerancePx, /*closed=*/true);
  Polygon polygon;
  for (const cv::Point2f& point : simple) polygon.emplace_back(point.x, point.y);
  return polygon;
}

std::optional<std::array<LineSegment2, 3>> ProjectedAxes(const Camera& camera,
                                                         const Landmark& landmark_in_camera) {
  const auto centre = camera.Project(landmark_in_camera.Centre());
  if (!centre) return std::nullopt;
  std::array<LineSegment2, 3> axes;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d end_in_object =
        landmark_in_camera.half_axes[i] * Eigen::Vector3d::Unit(i);
    const auto end = camera.Project(landmark_in_camera.frame_from_object * end_in_object);
    if (!end) return std::nullopt;
    axes[static_cast<size_t>(i)] = {*centre, *end};
  }
  return axes;
}

std::optional<LineSegment2> ProjectSegment(const Camera& camera, const LineSegment3& in_camera) {
  LineSegment3 visible = in_camera;
  const double first_z = in_camera[0].z();
  const double second_z = in_camera[1].z();
  if (std::max(first_z, second_z) <= kNearM) return std::nullopt;
  for (size_t i = 0; i < 2; ++i) {
    if (in_camera[i].z() >= kNearM) continue;
    const double share = (kNearM - first_z) / (second_z - first_z);
    visible[i] = in_camera[0] + share * (in_camera[1] - in_camera[0]);
  }
  return LineSegment2{*camera.Project(visible[0]), *camera.Project(visible[1])};
}

std::vector<LineSegment3> PlaneGrid(const Plane& plane,
                                    const std::vector<Eigen::Vector3d>& points) {
  const Rigid3d frame_from_plane = {UprightRotation(plane.normal, 0.0),
                                    -plane.offset * plane.normal};
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Array2d place = (frame_from_plane.Inverse() * point).head<2>().array();
    low = low.min(place - kGridMarginM);
    high = high.max(place + kGridMarginM);
  }
  const double squares = (high - low).maxCoeff() / kGridSpacingM;
  const double spacing = kGridSpacingM * std::ceil(squares / kMaxGridLines);
  low = (low / spacing).floor() * spacing;
  high = (high / spacing).ceil() * spacing;
  std::vector<LineSegment3> lines;
  for (Eigen::Index along = 0; along < 2; ++along) {
    const Eigen::Index across = 1 - along;
    const auto count = static_cast<int>(std::lround((high[across] - low[across]) / spacing));
    for (int i = 0; i <= count; ++i) {
      Eigen::Vector3d begin = Eigen::Vector3d::Zero();
      begin[across] = low[across] + i * spacing;
      Eigen::Vector3d end = begin;
      begin[along] = low[along];
      end[along] = high[along];
      lines.push_back({frame_from_plane * begin, frame_from_plane * end});
    }
  }
  return lines;
}

}  // namespace soslam
