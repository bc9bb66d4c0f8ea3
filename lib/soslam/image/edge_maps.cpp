// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/edge_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "soslam/base/error.h"
#include "soslam/image/binary_descriptor.h"

// cv::distanceTransform gives the nearest edge pixel as a label, but only together with a chamfer
// mask: on real images a tenth to a quarter of the labels are wrong and lead to an edge pixel up to
// 5 px farther than the nearest one. Hence the exact algorithm in two passes of Meijster, Roerdink
// and Hesselink, "A general algorithm for computing distance transforms in linear time" (2000):
// first the nearest edge pixel in the same column, then the nearest of these along the row.

namespace soslam {
namespace {

constexpr std::int16_t kNone = -1;

// An edge pixel whose column is the nearest one from pixel `first` of a row on.
struct Interval {
  int column = 0;
  int squared_height = 0;  // squared distance of the edge pixel from the row
  int first = 0;

  int SquaredDistanceAt(int x) const { return (x - column) * (x - column) + squared_height; }
};

}  // namespace

cv::Mat NearestEdgeMap(const cv::Mat& edges) {
  CV_Assert(edges.type() == CV_8UC1 && edges.cols <= 32767 && edges.rows <= 32767);
  // The row of the nearest edge pixel in the same column, the upper one of two; kNone in columns
  // without edges.
  cv::Mat nearest_row(edges.size(), CV_16SC1, cv::Scalar(kNone));
  std::vector<int> last(static_cast<size_t>(edges.cols), kNone);  // edge row seen last, by column
  for (int y = 0; y < edges.rows; ++y) {
    for (int x = 0; x < edges.cols; ++x) {
      int& row = last[x];
      if (edges.at<std::uint8_t>(y, x) != 0) row = y;
      nearest_row.at<std::int16_t>(y, x) = static_cast<std::int16_t>(row);
    }
  }
  for (int y = edges.rows - 2; y >= 0; --y) {
    for (int x = 0; x < edges.cols; ++x) {
      auto& above = nearest_row.at<std::int16_t>(y, x);
      const auto below = nearest_row.at<std::int16_t>(y + 1, x);
      if (below > y && (above == kNone || below - y < y - above)) above = below;
    }
  }
  cv::Mat nearest_edge(edges.size(), CV_16SC2, cv::Scalar(kNone, kNone));
  for (int y = 0; y < edges.rows; ++y) {
    std::vector<Interval> intervals;  // from left to right
    for (int u = 0; u < edges.cols; ++u) {
      const int row = nearest_row.at<std::int16_t>(y, u);
      if (row == kNone) continue;
      Interval next{u, (row - y) * (row - y), 0};
      while (!intervals.empty() && intervals.back().SquaredDistanceAt(intervals.back().first) >
                                       next.SquaredDistanceAt(intervals.back().first)) {
        intervals.pop_back();
      }
      if (!intervals.empty()) {
        const Interval& left = intervals.back();
        const int twice_apart = 2 * (next.column - left.column);
        const int difference = next.SquaredDistanceAt(0) - left.SquaredDistanceAt(0);
        const bool is_rounded_up = difference % twice_apart < 0;
        next.first = 1 + difference / twice_apart - (is_rounded_up ? 1 : 0);
      }
      if (next.first < edges.cols) intervals.push_back(next);
    }
    for (int x = edges.cols - 1; x >= 0 && !intervals.empty(); --x) {
      const int column = intervals.back().column;
      nearest_edge.at<cv::Vec2s>(y, x) = {static_cast<std::int16_t>(column),
                                          nearest_row.at<std::int16_t>(y, column)};
      if (x == intervals.back().first) intervals.pop_back();
    }
  }
  return nearest_edge;
}

cv::Mat DistanceMap(const cv::Mat& nearest_edge) {
  CV_Assert(nearest_edge.type() == CV_16SC2);
  cv::Mat distance(nearest_edge.size(), CV_32FC1);
  for (int y = 0; y < distance.rows; ++y) {
    for (int x = 0; x < distance.cols; ++x) {
      const auto& edge = nearest_edge.at<cv::Vec2s>(y, x);
      const int dx = edge[0] - x, dy = edge[1] - y;
      const double root = std::sqrt(static_cast<double>(dx * dx + dy * dy));
      distance.at<float>(y, x) =
          edge[0] == kNone ? std::numeric_limits<float>::infinity() : static_cast<float>(root);
    }
  }
  return distance;
}

void EdgesOptions::Check() const {
  if (canny_low > canny_high) {
    throw SettingsError(fmt::format("canny_low: is {}; expected at most canny_high, which is {}",
                                    canny_low, canny_high));
  }
}

EdgeMaps ComputeEdgeMaps(const cv::Mat& grey, const EdgesOptions& options) {
  CV_Assert(grey.type() == CV_8UC1 && !grey.empty());
  constexpr int kSobelSize = 3;
  constexpr bool kEuclideanGradient = true;  // the same threshold in all directions
  EdgeMaps maps;
  maps.grey = grey;
  cv::Mat blurred;  // other pixels than those of `grey`, which it would overwrite
  if (options.blur_sigma_px > 0.0) {
    cv::GaussianBlur(grey, blurred, cv::Size(), options.blur_sigma_px);
  } else {
    blurred = grey;
  }
  cv::Canny(blurred, maps.edges, options.canny_low, options.canny_high, kSobelSize,
            kEuclideanGradient);
  maps.nearest_edge = NearestEdgeMap(maps.edges);
  maps.distance = DistanceMap(maps.nearest_edge);
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(blurred, corners, options.max_corners, options.corner_quality,
                          options.corner_min_distance_px);
  for (const cv::Point2f& corner : corners) maps.corners.emplace_back(corner.x, corner.y);
  return maps;
}

std::optional<Eigen::Vector2d> NearestEdge(const EdgeMaps& maps, const Eigen::Vector2d& pixel) {
  const auto closest = PatchCentre(maps.nearest_edge.size(), pixel, 0);
  if (!closest) return std::nullopt;
  const auto& edge = maps.nearest_edge.at<cv::Vec2s>(*closest);
  if (edge[0] < 0) return std::nullopt;
  return Eigen::Vector2d(edge[0], edge[1]);
}

std::vector<LineSegment> FindLineSegments(const cv::Mat& grey, double min_length_px) {
  std::vector<cv::Vec4f> found;
  cv::createLineSegmentDetector()->detect(grey, found);
  std::vector<LineSegment> segments;
  for (const cv::Vec4f& line : found) {
    const LineSegment segment{{line[0], line[1]}, {line[2], line[3]}};
    if ((segment.end - segment.begin).norm() >= min_length_px) segments.push_back(segment);
  }
  return segments;
}

namespace {

template <typename Scalar>
std::optional<Sample> SampleTyped(const cv::Mat& map, const Eigen::Vector2d& pixel) {
  const int x = std::min(static_cast<int>(pixel.x()), map.cols - 2);
  const int y = std::min(static_cast<int>(pixel.y()), map.rows - 2);
  const Scalar* above = map.ptr<Scalar>(y) + x;
  const Scalar* below = map.ptr<Scalar>(y + 1) + x;
  const double dx = pixel.x() - x;
  const double dy = pixel.y() - y;
  const double top_left = above[0], top_right = above[1];
  const double bottom_left = below[0], bottom_right = below[1];
  const double top = (1.0 - dx) * top_left + dx * top_right;
  const double bottom = (1.0 - dx) * bottom_left + dx * bottom_right;
  const Sample sample{
      (1.0 - dy) * top + dy * bottom,
      {(1.0 - dy) * (top_right - top_left) + dy * (bottom_right - bottom_left), bottom - top}};
  if (!std::isfinite(sample.value)) return std::nullopt;  // as where any of the four is not
  return sample;
}

}  // namespace

bool IsBetweenPixelCentres(const cv::Mat& map, const Eigen::Vector2d& pixel) {  // false for NaN
  return map.cols >= 2 && map.rows >= 2 &&                                      //
         pixel.x() >= 0.0 && pixel.x() <= map.cols - 1.0 &&                     //
         pixel.y() >= 0.0 && pixel.y() <= map.rows - 1.0;
}

std::optional<Sample> SampleBilinear(const cv::Mat& map, const Eigen::Vector2d& pixel) {
  CV_Assert(map.type() == CV_8UC1 || map.type() == CV_32FC1);
  if (!IsBetweenPixelCentres(map, pixel)) return std::nullopt;
  return map.type() == CV_8UC1 ? SampleTyped<std::uint8_t>(map, pixel)
                               : SampleTyped<float>(map, pixel);
}

}  // namespace soslam
