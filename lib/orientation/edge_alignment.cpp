// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/edge_alignment.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "constraints/loss.h"
#include "geometry/angles.h"
#include "geometry/wireframe.h"
#include "image/sample_bilinear.h"

namespace soslam {

FrameEdges::FrameEdges(EdgeMaps edge_maps) : maps(std::move(edge_maps)) {
  cv::Mat smooth;
  cv::GaussianBlur(maps.grey, smooth, cv::Size(), 1.0);
  cv::Sobel(smooth, slope_x, CV_32F, 1, 0);
  cv::Sobel(smooth, slope_y, CV_32F, 0, 1);
}

EdgeTerm::EdgeTerm(std::shared_ptr<const EdgeImage> image, const Camera& camera,
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

bool EdgeTerm::Counts(const ModelPoint& point, const Landmark& start_in_camera) const {
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

double EdgeTerm::Support(const Landmark& landmark_in_camera) const {
  const double largest = (points_that_do_not_count_ + NumPoints()) * LargestCost();
  return 1.0 - (Value(landmark_in_camera) + ConstantCost()) / largest;
}

double EdgeTerm::Residual(const Landmark& landmark, const Eigen::Matrix3d& rotation,
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
        robust.slope * camera_.ProjectionJacobian(in_camera).transpose() * distance->gradient;
    *jacobian << from_centre.cross(d_point).transpose(), d_point.transpose(),
        (rotation.transpose() * d_point).cwiseProduct(in_object).transpose();
  }
  return robust.value;
}

double EdgeTerm::Value(const Landmark& landmark_in_camera) const {
  const Eigen::Matrix3d rotation = landmark_in_camera.frame_from_object.rotation.toRotationMatrix();
  double sum = 0.0;
  for (const Eigen::Vector3d& point : in_unit_body_) {
    const double residual = Residual(landmark_in_camera, rotation, point, nullptr);
    sum += residual * residual;
  }
  return 0.5 * weight_ * sum;
}

void EdgeTerm::AddTo(const Landmark& landmark_in_camera, LandmarkModel* sum) const {
  const Eigen::Matrix3d rotation = landmark_in_camera.frame_from_object.rotation.toRotationMatrix();
  LandmarkModel points;
  for (const Eigen::Vector3d& point : in_unit_body_) {
    LandmarkJacobian1 jacobian;
    const double residual = Residual(landmark_in_camera, rotation, point, &jacobian);
    points.Add(residual, jacobian.transpose());
  }
  sum->Add(points, weight_);
}

EdgeTerm SupportedEdgeTerm(std::shared_ptr<const EdgeImage> image, const Camera& camera,
                           const Landmark& start_in_camera, const EdgeOptions& options,
                           double weight) {
  EdgeTerm term(std::move(image), camera, start_in_camera, options);
  const double support = term.Support(start_in_camera);
  term.Weigh(weight * support * support);
  return term;
}

}  // namespace soslam
