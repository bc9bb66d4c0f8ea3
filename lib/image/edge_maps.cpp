// SPDX-License-Identifier: BSD-3-Clause
#include "image/edge_maps.h"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "image/nearest_edge.h"

namespace soslam {
namespace {

cv::Mat DetectEdges(const cv::Mat& grey, const EdgesOptions& options) {
  cv::Mat blurred = grey;
  if (options.blur_sigma_px > 0.0) {
    cv::GaussianBlur(grey, blurred, cv::Size(), options.blur_sigma_px);
  }
  cv::Mat edges;
  constexpr int kSobelSize = 3;
  constexpr bool kEuclideanGradient = true;  // the same threshold in all directions
  cv::Canny(blurred, edges, options.canny_low, options.canny_high, kSobelSize, kEuclideanGradient);
  return edges;
}

std::vector<Eigen::Vector2f> DetectCorners(const cv::Mat& grey, const EdgesOptions& options) {
  std::vector<cv::Point2f> points;
  cv::goodFeaturesToTrack(grey, points, options.max_corners, options.corner_quality,
                          options.corner_min_distance_px);
  std::vector<Eigen::Vector2f> corners;
  corners.reserve(points.size());
  for (const cv::Point2f& point : points) corners.emplace_back(point.x, point.y);
  return corners;
}

}  // namespace

void EdgesOptions::Check() const {
  if (canny_low > canny_high) {
    throw SettingsError(fmt::format("canny_low: is {}; expected at most canny_high, which is {}",
                                    canny_low, canny_high));
  }
}

EdgeMaps ComputeEdgeMaps(const cv::Mat& grey, const EdgesOptions& options) {
  CV_Assert(grey.type() == CV_8UC1 && !grey.empty());
  EdgeMaps maps;
  maps.grey = grey;
  maps.edges = DetectEdges(grey, options);
  maps.nearest_edge = NearestEdgeMap(maps.edges);
  maps.distance = DistanceMap(maps.nearest_edge);
  maps.corners = DetectCorners(grey, options);
  return maps;
}

std::optional<Eigen::Vector2d> NearestEdge(const EdgeMaps& maps, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d closest = (pixel.array() + 0.5).floor();
  const bool inside = closest.x() >= 0 && closest.x() < maps.nearest_edge.cols &&  //
                      closest.y() >= 0 && closest.y() < maps.nearest_edge.rows;
  if (!inside) return std::nullopt;  // also for NaN
  const auto& edge =
      maps.nearest_edge.at<cv::Vec2s>(static_cast<int>(closest.y()), static_cast<int>(closest.x()));
  if (edge[0] < 0) return std::nullopt;
  return Eigen::Vector2d(edge[0], edge[1]);
}

}  // namespace soslam
