// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/inspection/projection.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace soslam {
namespace {

constexpr double kOutlineTolerancePx = 0.5;
constexpr double kGridSpacingM = 0.5;
constexpr double kGridMarginM = 0.5;  // around the contact points

}  // namespace

Polygon CornersOf(const Box& box) {
  return {{box.x_min, box.y_min},
          {box.x_max, box.y_min},
          {box.x_max, box.y_max},
          {box.x_min, box.y_max}};
}

Polygon OutlinePolygon(const Camera& camera, const Landmark& landmark_in_camera) {
  if (!IsInFront(landmark_in_camera)) return {};
  std::vector<Eigen::Vector3d> points_in_camera;
  if (landmark_in_camera.shape_exponents == kCuboidExponent) {
    for (const LineSegment3& edge : UnitCuboidEdges()) {
      for (const Eigen::Vector3d& corner : edge) {
        points_in_camera.push_back(PointAt(landmark_in_camera, corner));
      }
    }
  } else {
    points_in_camera = SilhouettePoints(camera, landmark_in_camera);
  }
  std::vector<cv::Point2f> touched;
  for (const Eigen::Vector3d& point : points_in_camera) {
    const Eigen::Vector2f pixel = camera.Project(point)->cast<float>();
    touched.emplace_back(pixel.x(), pixel.y());
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
  std::array<LineSegment2, 3> axes;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
    const Eigen::Vector3d from = i == 0 ? Eigen::Vector3d(-axis) : Eigen::Vector3d::Zero();
    const auto begin = camera.Project(PointAt(landmark_in_camera, from));
    const auto end = camera.Project(PointAt(landmark_in_camera, axis));
    if (!begin || !end) return std::nullopt;
    axes[i] = {*begin, *end};
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

Grid GridAround(const Plane& plane, const std::vector<Eigen::Vector3d>& points) {
  const Rigid3d frame_from_plane = {UprightRotation(plane.normal, 0.0),
                                    -plane.offset * plane.normal};
  Eigen::AlignedBox2d extent;
  for (const Eigen::Vector3d& point : points) {
    extent.extend((frame_from_plane.Inverse() * point).head<2>());
  }
  Eigen::Array2d low = extent.min().array() - kGridMarginM;
  Eigen::Array2d high = extent.max().array() + kGridMarginM;
  const double squares = (high - low).maxCoeff() / kGridSpacingM;
  const double spacing = kGridSpacingM * std::ceil(squares / kMaxGridLines);
  low = (low / spacing).floor() * spacing;
  high = (high / spacing).ceil() * spacing;
  Grid grid{spacing, {}};
  for (Eigen::Index along = 0; along < 2; ++along) {
    const Eigen::Index across = 1 - along;
    const auto count = static_cast<int>(std::lround((high[across] - low[across]) / spacing));
    for (int i = 0; i <= count; ++i) {
      Eigen::Vector3d begin = Eigen::Vector3d::Zero();
      begin[across] = low[across] + i * spacing;
      Eigen::Vector3d end = begin;
      begin[along] = low[along];
      end[along] = high[along];
      grid.lines.push_back({frame_from_plane * begin, frame_from_plane * end});
    }
  }
  return grid;
}

}  // namespace soslam
