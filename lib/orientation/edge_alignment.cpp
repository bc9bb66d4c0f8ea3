// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/edge_alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "base/wide_loops.h"
#include "geometry/angles.h"
#include "initialisation/residual_batch.h"

namespace soslam {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The points of a batch, transformed and projected for one landmark.
struct Projection {
  BatchOfVectors in_object;
  BatchOfVectors from_centre;  // in the camera frame
  BatchOfVectors in_camera;
  Batch inverse_depth;   // NaN behind the camera
  BatchOfPixels pixels;  // NaN behind the camera
};

SOSLAM_MULTIVERSION void Project(const Camera& camera, const Landmark& landmark,
                                 const BatchOfVectors& in_unit_body, Projection* projection) {
  const Eigen::Matrix3d rotation = landmark.frame_from_object.rotation.toRotationMatrix();
  const Eigen::Vector3d centre = landmark.Centre();
  for (size_t k = 0; k < 3; ++k) {
    const double half_axis = landmark.half_axes[static_cast<Eigen::Index>(k)];
    for (int i = 0; i < kBatchSize; ++i) {
      projection->in_object[k][i] = half_axis * in_unit_body[k][i];
    }
  }
  const BatchOfVectors& x = projection->in_object;
  for (size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double a = rotation(row, 0), b = rotation(row, 1), c = rotation(row, 2);
    const double origin = centre[row];
    for (int i = 0; i < kBatchSize; ++i) {
      const double from_centre = a * x[0][i] + b * x[1][i] + c * x[2][i];
      projection->from_centre[k][i] = from_centre;
      projection->in_camera[k][i] = from_centre + origin;
    }
  }
  const double fx = camera.fx, fy = camera.fy, cx = camera.cx, cy = camera.cy;
  for (int i = 0; i < kBatchSize; ++i) {
    const double depth = projection->in_camera[2][i];
    const double inverse_depth = 1.0 / depth + (depth > 0.0 ? 0.0 : kNone);
    projection->inverse_depth[i] = inverse_depth;
    projection->pixels[0][i] = fx * projection->in_camera[0][i] * inverse_depth + cx;
    projection->pixels[1][i] = fy * projection->in_camera[1][i] * inverse_depth + cy;
  }
}

// D / sqrt(1 + D^2 / tau^2) of a distance D, and its derivative. If there is no distance, tau, the
// limit for large ones. Both are 0 for padding.
void Truncate(const Batch& distance, const Batch& is_point, double tau, Batch* residual,
              Batch* slope) {
  const Batch inverse_root = (1.0 + (distance / tau).square()).sqrt().inverse();
  const auto is_seen = inverse_root > 0.0;  // false for NaN
  *residual = is_point * is_seen.select(distance * inverse_root, tau);
  *slope = is_point * is_seen.select(inverse_root.cube(), 0.0);
}

// Derivatives of the residuals by the landmark.
SOSLAM_MULTIVERSION void Differentiate(const Camera& camera, const Eigen::Matrix3d& rotation,
                                       const Projection& at, const BatchOfPixels& gradients,
                                       const Batch& slope, ResidualBatch* batch) {
  const double fx = camera.fx, fy = camera.fy;
  auto& [w_x, w_y, w_z, c_x, c_y, c_z, log_a, log_b, log_c] = batch->by_landmark;
  for (int i = 0; i < kBatchSize; ++i) {
    // Derivatives by the point in the camera frame.
    const bool is_seen = slope[i] > 0.0;
    const double seen_inverse_depth = is_seen ? at.inverse_depth[i] : 0.0;
    const double scale = slope[i] * seen_inverse_depth;
    const double by_x = scale * fx * gradients[0][i];
    const double by_y = scale * fy * gradients[1][i];
    const double away = at.in_camera[0][i] * by_x + at.in_camera[1][i] * by_y;
    const double by_z = -seen_inverse_depth * away;
    const double x = at.from_centre[0][i], y = at.from_centre[1][i], z = at.from_centre[2][i];
    w_x[i] = y * by_z - z * by_y;
    w_y[i] = z * by_x - x * by_z;
    w_z[i] = x * by_y - y * by_x;
    c_x[i] = by_x;
    c_y[i] = by_y;
    c_z[i] = by_z;
  }
  const std::array<Batch*, 3> by_log_half_axes = {&log_a, &log_b, &log_c};
  for (size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const double a = rotation(0, axis), b = rotation(1, axis), c = rotation(2, axis);
    for (int i = 0; i < kBatchSize; ++i) {
      (*by_log_half_axes[k])[i] = (a * c_x[i] + b * c_y[i] + c * c_z[i]) * at.in_object[k][i];
    }
  }
}

}  // namespace

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
  Keep(points);
  const double observations =
      2.0 * (image_->box.Width() + image_->box.Height()) / options.edge_correlation_px;
  weight_ = observations / (count * options.edge_sigma_px * options.edge_sigma_px);
}

void EdgeTerm::Keep(const std::vector<ModelPoint>& points) {
  num_points_ = static_cast<int>(points.size());
  in_unit_body_.assign((points.size() + kBatchSize - 1) / kBatchSize,
                       {Batch::Zero(), Batch::Zero(), Batch::Zero()});
  is_point_.assign(in_unit_body_.size(), Batch::Zero());
  for (size_t i = 0; i < points.size(); ++i) {
    const size_t batch = i / kBatchSize;
    const auto place = static_cast<Eigen::Index>(i % kBatchSize);
    for (size_t k = 0; k < 3; ++k) {
      in_unit_body_[batch][k][place] = points[i].in_unit_body[static_cast<Eigen::Index>(k)];
    }
    is_point_[batch][place] = 1.0;
  }
}

bool EdgeTerm::Counts(const ModelPoint& point, const Landmark& start_in_camera) const {
  const auto pixel = camera_.Project(start_in_camera.frame_from_object *
                                     start_in_camera.half_axes.cwiseProduct(point.in_unit_body));
  const FrameEdges& frame = *image_->frame;
  if (!pixel || !IsBetweenPixelCentres(frame.maps.distance, *pixel)) return false;
  const auto nearest = NearestEdge(frame.maps, *pixel);
  const bool is_hidden = std::any_of(image_->nearer_boxes.begin(), image_->nearer_boxes.end(),
                                     [&](const Box& box) { return box.Contains(*pixel); });
  if (!nearest || is_hidden) return false;
  const cv::Point at(static_cast<int>(nearest->x()), static_cast<int>(nearest->y()));
  const Eigen::Vector2d edge(-frame.slope_y.at<float>(at), frame.slope_x.at<float>(at));
  return std::abs(point.along.dot(edge)) >= edge.norm() * least_cosine_;
}

double EdgeTerm::Support(const Landmark& landmark_in_camera) const {
  const double largest = (points_that_do_not_count_ + num_points_) * LargestCost();
  return 1.0 - (Value(landmark_in_camera) + ConstantCost()) / largest;
}

double EdgeTerm::Value(const Landmark& landmark_in_camera) const {
  double sum = 0.0;
  for (size_t batch = 0; batch < in_unit_body_.size(); ++batch) {
    Projection at;
    Project(camera_, landmark_in_camera, in_unit_body_[batch], &at);
    Batch residual, slope;
    Truncate(SampleBilinear(image_->frame->maps.distance, at.pixels), is_point_[batch],
             options_.edge_truncation_px, &residual, &slope);
    sum += residual.square().sum();
  }
  return 0.5 * weight_ * sum;
}

void EdgeTerm::AddTo(const Landmark& landmark_in_camera, LandmarkModel* sum) const {
  const Eigen::Matrix3d rotation = landmark_in_camera.frame_from_object.rotation.toRotationMatrix();
  for (size_t batch = 0; batch < in_unit_body_.size(); ++batch) {
    Projection at;
    Project(camera_, landmark_in_camera, in_unit_body_[batch], &at);
    BatchOfPixels gradients;
    const Batch distance = SampleBilinear(image_->frame->maps.distance, at.pixels, &gradients);
    ResidualBatch residuals;
    Batch slope;
    Truncate(distance, is_point_[batch], options_.edge_truncation_px, &residuals.residual, &slope);
    Differentiate(camera_, rotation, at, gradients, slope, &residuals);
    residuals.AddTo(weight_, sum);
  }
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
