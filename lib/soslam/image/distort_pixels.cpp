// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/distort_pixels.h"

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace soslam {
namespace {

cv::Matx33d Intrinsics(const Camera& camera) {
  cv::Matx33d intrinsics;
  cv::eigen2cv(camera.Intrinsics(), intrinsics);
  return intrinsics;
}

}  // namespace

std::vector<Eigen::Vector2d> DistortPixels(const Camera& camera, const Distortion& distortion,
                                           const std::vector<Eigen::Vector2d>& pixels) {
  if (pixels.empty()) return {};
  std::vector<cv::Point3d> points;
  for (const Eigen::Vector2d& pixel : pixels) {
    const Eigen::Vector3d ray = camera.Ray(pixel);
    points.emplace_back(ray.x(), ray.y(), ray.z());
  }
  std::vector<cv::Point2d> projected;
  cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), Intrinsics(camera),
                    DistortionCoefficients(distortion), projected);
  std::vector<Eigen::Vector2d> distorted;
  for (const cv::Point2d& point : projected) distorted.emplace_back(point.x, point.y);
  return distorted;
}

std::vector<std::optional<Eigen::Vector2d>> UndistortPixels(
    const Camera& camera, const Distortion& distortion,
    const std::vector<Eigen::Vector2d>& distorted) {
  if (distorted.empty()) return {};
  std::vector<cv::Point2d> points;
  for (const Eigen::Vector2d& pixel : distorted) points.emplace_back(pixel.x(), pixel.y());
  // OpenCV iterates to invert the model. Where it does not converge, distorting the result does not
  // give the input back.
  const cv::TermCriteria iterations(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-9);
  constexpr double kTolerancePx = 1e-3;
  std::vector<cv::Point2d> solutions;
  cv::undistortPoints(points, solutions, Intrinsics(camera), DistortionCoefficients(distortion),
                      cv::noArray(), Intrinsics(camera), iterations);
  std::vector<Eigen::Vector2d> pixels;
  for (const cv::Point2d& solution : solutions) pixels.emplace_back(solution.x, solution.y);
  const auto distorted_again = DistortPixels(camera, distortion, pixels);
  std::vector<std::optional<Eigen::Vector2d>> undistorted;
  for (size_t i = 0; i < pixels.size(); ++i) {
    const double error = (distorted_again[i] - distorted[i]).norm();
    undistorted.push_back(error <= kTolerancePx ? std::optional(pixels[i]) : std::nullopt);
  }
  return undistorted;
}

std::optional<Box> UndistortBox(const Camera& camera, const Distortion& distortion,
                                const Box& distorted) {
  // Points along the four edges. For an edge that bows out by b px between two corners, they miss
  // the outermost point by at most b / kIntervals^2, a thousandth of the bow.
  constexpr int kIntervals = 32;
  const auto& [x_min, y_min, x_max, y_max] = distorted;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i <= kIntervals; ++i) {
    const double t = static_cast<double>(i) / kIntervals;
    const double x = x_min + t * distorted.Width();
    const double y = y_min + t * distorted.Height();
    outline.insert(outline.end(), {{x, y_min}, {x, y_max}, {x_min, y}, {x_max, y}});
  }
  Eigen::AlignedBox2d around;
  for (const auto& pixel : UndistortPixels(camera, distortion, outline)) {
    if (!pixel) return std::nullopt;
    around.extend(*pixel);
  }
  return Box{around.min().x(), around.min().y(), around.max().x(), around.max().y()};
}

}  // namespace soslam
