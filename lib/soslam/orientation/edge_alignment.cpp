// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/edge_alignment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "soslam/constraints/loss.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/wireframe.h"

namespace soslam {
namespace {

// Standard deviation of the blur before slopes are taken: that of two blurs by one pixel.
constexpr double kSlopeBlurPx = std::numbers::sqrt2;

// Up to this exponent, the larger of the two, an object has edges of its own, beyond it only a
// silhouette.
constexpr double kMaxEdgyExponent = 1.3;

// The silhouette as a closed polygon, in the unit body.
std::vector<LineSegment3> OutlineEdges(const Camera& camera, const Landmark& landmark) {
  const Rigid3d object_from_camera = landmark.frame_from_object.Inverse();
  std::vector<Eigen::Vector3d> silhouette = SilhouettePoints(camera, landmark);
  for (Eigen::Vector3d& point : silhouette) {
    point = (object_from_camera * point).cwiseQuotient(landmark.half_axes);
  }
  std::vector<LineSegment3> edges;
  for (size_t i = 0; i < silhouette.size(); ++i) {
    edges.push_back({silhouette[i], silhouette[(i + 1) % silhouette.size()]});
  }
  return edges;
}

}  // namespace

std::vector<ModelPoint> VisibleModelPoints(const Camera& camera, const Landmark& landmark_in_camera,
                                           double spacing_px) {
  if (!IsInFront(landmark_in_camera)) return {};
  const auto [of_sections, of_curve] = landmark_in_camera.shape_exponents;
  const bool is_edgy = std::max(of_sections, of_curve) <= kMaxEdgyExponent;
  std::vector<ModelPoint> points;
  double carried = 0.0;
  for (const auto& [unit_start, unit_end] : is_edgy ? VisibleCuboidEdges(landmark_in_camera)
                                                    : OutlineEdges(camera, landmark_in_camera)) {
    const auto start = camera.Project(PointAt(landmark_in_camera, unit_start));
    const auto end = camera.Project(PointAt(landmark_in_camera, unit_end));
    if (!start || !end) continue;
    const double length = (*end - *start).norm();
    // Points are in the middle of equal parts. An edge shorter than the spacing carries its
    // fraction of a point over to the next ones.
    carried += length / spacing_px;
    const int count = static_cast<int>(carried);
    carried -= count;
    for (int i = 0; i < count; ++i) {
      const double t = (i + 0.5) / count;
      points.push_back({unit_start + t * (unit_end - unit_start), (*end - *start) / length});
    }
  }
  return points;
}

FrameEdges::FrameEdges(EdgeMaps edge_maps) : maps(std::move(edge_maps)) {
  cv::Mat smooth;
  cv::GaussianBlur(maps.grey, smooth, cv::Size(), kSlopeBlurPx);
  cv::Sobel(smooth, slope_x, CV_32F, 1, 0);
  cv::Sobel(smooth, slope_y, CV_32F, 0, 1);
}

EdgeCost::EdgeCost(std::shared_ptr<const EdgeImage> image, const Camera& camera,
                   const Landmark& start_in_camera, const EdgeOptions& options)
    : image_(std::move(image)),
      camera_(camera),
      options_(options),
      least_cosine_(options.edge_direction_tolerance_deg >= 90.0
                        ? 0.0
                        : std::cos(options.edge_direction_tolerance_deg * kRadPerDeg)) {
  std::vector<ModelPoint> points =
      VisibleModelPoints(camera, start_in_camera, options.edge_spacing_px);
  // A landmark that is not in front of the camera has no usable points.
  const auto count = static_cast<double>(std::max<size_t>(1, points.size()));
  std::erase_if(points, [&](const ModelPoint& point) { return !Counts(point, start_in_camera); });
  points_that_do_not_count_ = count - static_cast<double>(points.size());
  for (const ModelPoint& point : points) in_unit_body_.push_back(point.in_unit_body);
  const double observations =
      2.0 * (image_->box.Width() + image_->box.Height()) / options.edge_correlation_px;
  weight_ = observations / (count * options.edge_sigma_px * options.edge_sigma_px);
}

bool EdgeCost::Counts(const ModelPoint& point, const Landmark& start_in_camera) const {
  const auto pixel = camera_.Project(PointAt(start_in_camera, point.in_unit_body));
  const FrameEdges& frame = *image_->frame;
  if (!pixel || !IsBetweenPixelCentres(frame.maps.distance, *pixel)) return false;
  const auto nearest = NearestEdge(frame.maps, *pixel);
  const bool is_hidden = std::ranges::any_of(image_->nearer_boxes,
                                             [&](const Box& box) { return box.Contains(*pixel); });
  if (!nearest || is_hidden) return false;
  const cv::Point at(static_cast<int>(nearest->x()), static_cast<int>(nearest->y()));
  const Eigen::Vector2d edge(-frame.slope_y.at<float>(at), frame.slope_x.at<float>(at));
  return std::abs(point.along.dot(edge)) >= edge.norm() * least_cosine_;
}

double EdgeCost::Support(const Landmark& landmark_in_camera) const {
  const double largest = (points_that_do_not_count_ + NumPoints()) * LargestCost();
  return 1.0 - (Value(landmark_in_camera) + ConstantCost()) / largest;
}

double EdgeCost::Residual(const Landmark& landmark, const Eigen::Matrix3d& rotation,
                          const Eigen::Vector3d& in_unit_body, LandmarkJacobian1* jacobian) const {
  if (jacobian != nullptr) jacobian->setZero();
  const Eigen::Vector3d in_object = landmark.half_axes.cwiseProduct(in_unit_body);
  const Eigen::Vector3d from_centre = rotation * in_object;
  const Eigen::Vector3d in_camera = from_centre + landmark.Centre();
  const auto pixel = camera_.Project(in_camera);
  const auto distance = pixel ? SampleBilinear(image_->frame->maps.distance, *pixel) : std::nullopt;
  if (!distance) return options_.edge_truncation_px;  // the limit for large distances
  const RobustResidual robust =
      RobustifyResidual(GemanMcClureLoss(options_.edge_truncation_px), distance->value);
  if (jacobian != nullptr) {
    const Eigen::Vector3d d_point =
        camera_.ProjectionJacobian(in_camera).transpose() * (robust.slope * distance->gradient);
    jacobian->head<3>() = from_centre.cross(d_point);
    jacobian->segment<3>(3) = d_point;
    jacobian->tail<3>() = (rotation.transpose() * d_point).cwiseProduct(in_object);
  }
  return robust.value;
}

double EdgeCost::Value(const Landmark& landmark_in_camera) const {
  const Eigen::Matrix3d rotation = landmark_in_camera.frame_from_object.rotation.toRotationMatrix();
  double sum = 0.0;
  for (const Eigen::Vector3d& point : in_unit_body_) {
    const double residual = Residual(landmark_in_camera, rotation, point, nullptr);
    sum += residual * residual;
  }
  return 0.5 * weight_ * sum;
}

void EdgeCost::AddTo(const Landmark& landmark_in_camera, LandmarkModel* sum) const {
  const Eigen::Matrix3d rotation = landmark_in_camera.frame_from_object.rotation.toRotationMatrix();
  LandmarkModel points;
  for (const Eigen::Vector3d& point : in_unit_body_) {
    LandmarkJacobian1 jacobian;
    const double residual = Residual(landmark_in_camera, rotation, point, &jacobian);
    points.Add(residual, jacobian.transpose());
  }
  sum->Add(points, weight_);
}

}  // namespace soslam
