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

FrameEdges::FrameEdges(EdgeMaps edge_maps)
    : maps(std::move(edge_maps)), direction(EdgeDirections(maps.grey)) {}

EdgeTerm::EdgeTerm(const EdgeImage& image, const Camera& camera, const Landmark& start_in_camera,
                   const EdgeOptions& options)
    : image_(image), camera_(camera), options_(options) {
  const auto all = VisibleModelPoints(camera, start_in_camera, options.edge_spacing_px);
  std::copy_if(all.begin(), all.end(), std::back_inserter(points_),
               [&](const ModelPoint& point) { return Counts(point, start_in_camera); });
  // Of a body that is not in front of the camera no point counts.
  const auto count = static_cast<double>(std::max<size_t>(1, all.size()));
  points_that_do_not_count_ = count - static_cast<double>(points_.size());
  const double observations =
      2.0 * (image.box.Width() + image.box.Height()) / options.edge_correlation_px;
  weight_ = std::sqrt(observations / count) / options.edge_sigma_px;
}

bool EdgeTerm::Counts(const ModelPoint& point, const Landmark& start_in_camera) const {
  const auto pixel = camera_.Project(start_in_camera.frame_from_object *
                                     start_in_camera.half_axes.cwiseProduct(point.in_unit_body));
  if (!pixel || !SampleBilinear(image_.frame->maps.distance, *pixel)) return false;
  const auto nearest = NearestEdge(image_.frame->maps, *pixel);
  const bool is_hidden = std::any_of(image_.nearer_boxes.begin(), image_.nearer_boxes.end(),
                                     [&](const Box& box) { return box.Contains(*pixel); });
  if (!nearest || is_hidden) return false;
  const double direction = image_.frame->direction.at<float>(static_cast<int>(nearest->y()),
                                                             static_cast<int>(nearest->x()));
  const double alignment =
      std::abs(point.along.dot(Eigen::Vector2d(std::cos(direction), std::sin(direction))));
  return alignment >= std::cos(options_.edge_direction_tolerance_deg * std::numbers::pi / 180.0);
}

double EdgeTerm::Support(const Landmark& landmark_in_camera) const {
  Eigen::VectorXd residuals(NumResiduals());
  Evaluate(landmark_in_camera, residuals, nullptr);
  const double largest = (points_that_do_not_count_ + NumResiduals()) * LargestCost();
  return 1.0 - (0.5 * residuals.squaredNorm() + ConstantCost()) / largest;
}

void EdgeTerm::Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                        Jacobian* jacobian) const {
  const double tau = options_.edge_truncation_px;
  const Eigen::Matrix3d rotation = landmark_in_camera.frame_from_object.rotation.toRotationMatrix();
  if (jacobian != nullptr) jacobian->setZero();
  for (size_t i = 0; i < points_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d in_object =
        landmark_in_camera.half_axes.cwiseProduct(points_[i].in_unit_body);
    const Eigen::Vector3d offset = rotation * in_object;
    const Eigen::Vector3d in_camera = offset + landmark_in_camera.Centre();
    const auto pixel = camera_.Project(in_camera);
    const auto distance =
        pixel ? SampleBilinear(image_.frame->maps.distance, *pixel) : std::nullopt;
    if (!distance) {  // has left the image: the limit of ever larger distances
      residuals[row] = weight_ * tau;
      continue;
    }
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
