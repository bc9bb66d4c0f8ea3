// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/edge_alignment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace soslam {
namespace {

cv::Mat EdgeDirections(const cv::Mat& grey) {
  cv::Mat smooth, by_x, by_y, direction;
  cv::GaussianBlur(grey, smooth, cv::Size(), 1.0);
  cv::Sobel(smooth, by_x, CV_32F, 1, 0);
  cv::Sobel(smooth, by_y, CV_32F, 0, 1);
  cv::phase(by_y, -by_x, direction);  // at right angles to the gradient
  return direction;
}

}  // namespace

EdgeImage::EdgeImage(const EdgeMaps& edge_maps, const Box& own_box, std::vector<Box> boxes)
    : box(own_box),
      maps(edge_maps),
      edge_direction(EdgeDirections(edge_maps.grey)),
      nearer_boxes(std::move(boxes)) {}

EdgeTerm::EdgeTerm(const EdgeImage& image, const Camera& camera, const Landmark& start_in_camera,
                   const EdgeOptions& options)
    : image_(image), camera_(camera), options_(options) {
  for (const ModelPoint& point :
       VisibleModelPoints(camera, start_in_camera, options.edge_spacing_px)) {
    const auto pixel = camera.Project(start_in_camera.frame_from_object *
                                      start_in_camera.half_axes.cwiseProduct(point.in_unit_body));
    if (!pixel || !SampleBilinear(image.maps.distance, *pixel)) continue;
    const bool hidden = std::any_of(image.nearer_boxes.begin(), image.nearer_boxes.end(),
                                    [&](const Box& box) { return box.Contains(*pixel); });
    if (!hidden) points_.push_back(point);
  }
  const double observations =
      2.0 * (image.box.Width() + image.box.Height()) / options.edge_correlation_px;
  weight_ = std::sqrt(observations / static_cast<double>(std::max<size_t>(1, points_.size()))) /
            options.edge_sigma_px;
}

double EdgeTerm::Support(const Landmark& landmark_in_camera) const {
  if (points_.empty()) return 0.0;
  Eigen::VectorXd residuals(NumResiduals());
  Evaluate(landmark_in_camera, residuals, nullptr);
  const double largest = weight_ * options_.edge_truncation_px;
  return 1.0 - residuals.squaredNorm() / (NumResiduals() * largest * largest);
}

void EdgeTerm::Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                        Jacobian* jacobian) const {
  const double tau = options_.edge_truncation_px;
  const double tolerance =
      std::cos(options_.edge_direction_tolerance_deg * std::numbers::pi / 180.0);
  const Eigen::Matrix3d rotation = landmark_in_camera.frame_from_object.rotation.toRotationMatrix();
  if (jacobian != nullptr) jacobian->setZero();
  for (size_t i = 0; i < points_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    residuals[row] = weight_ * tau;
    const Eigen::Vector3d in_object =
        landmark_in_camera.half_axes.cwiseProduct(points_[i].in_unit_body);
    const Eigen::Vector3d offset = rotation * in_object;
    const Eigen::Vector3d in_camera = offset + landmark_in_camera.Centre();
    const auto pixel = camera_.Project(in_camera);
    if (!pixel) continue;
    const auto distance = SampleBilinear(image_.maps.distance, *pixel);
    const auto nearest = NearestEdge(image_.maps, *pixel);
    if (!distance || !nearest) continue;
    const double direction = image_.edge_direction.at<float>(static_cast<int>(nearest->y()),
                                                             static_cast<int>(nearest->x()));
    const double alignment = std::abs(points_[i].along.x() * std::cos(direction) +
                                      points_[i].along.y() * std::sin(direction));
    if (alignment < tolerance) continue;
    // D / sqrt(1 + D^2 / tau^2)
    const double ratio = distance->value / tau;
    const double root = std::sqrt(1.0 + ratio * ratio);
    residuals[row] = weight_ * distance->value / root;
    if (jacobian == nullptr) continue;
    const double slope = weight_ / (root * root * root);
    const double inverse_depth = 1.0 / in_camera.z();
    const Eigen::RowVector3d by_point =
        slope * inverse_depth *
        Eigen::RowVector3d(camera_.fx * distance->gradient.x(), camera_.fy * distance->gradient.y(),
                           -inverse_depth * (camera_.fx * in_camera.x() * distance->gradient.x() +
                                             camera_.fy * in_camera.y() * distance->gradient.y()));
    jacobian->row(row) << -by_point * Skew(offset), by_point,
        (by_point * rotation).cwiseProduct(in_object.transpose());
  }
}

EdgeAlignmentResidual::EdgeAlignmentResidual(std::shared_ptr<const EdgeImage> image,
                                             const Camera& camera, const Landmark& start_in_camera,
                                             const EdgeOptions& options, double weight)
    : image_(std::move(image)),
      term_(*image_, camera, start_in_camera, options),
      shape_exponent_(start_in_camera.shape_exponent) {
  const double support = term_.Support(start_in_camera);
  term_.Weigh(weight * support * support);
  set_num_residuals(term_.NumResiduals());
  *mutable_parameter_block_sizes() = {kPoseSize, kLandmarkSize};
}

bool EdgeAlignmentResidual::Evaluate(double const* const* blocks, double* residuals,
                                     double** jacobians) const {
  const RelativeObservation observation(blocks, shape_exponent_);
  const int rows = term_.NumResiduals();
  LandmarkTerm::Jacobian by_landmark(rows, kLandmarkDof);
  term_.Evaluate(observation.landmark_in_camera(), Eigen::Map<Eigen::VectorXd>(residuals, rows),
                 jacobians != nullptr ? &by_landmark : nullptr);
  observation.WriteJacobians<Eigen::Dynamic>(by_landmark, blocks, jacobians);
  return true;
}

}  // namespace soslam
