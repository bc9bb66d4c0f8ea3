// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/edge_alignment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "constraints/loss.h"
#include "geometry/angles.h"
#include "geometry/wireframe.h"

namespace soslam {
namespace {

// Standard deviation of the blur before slopes are taken: that of two blurs by one pixel.
constexpr double kSlopeBlurPx = std::numbers::sqrt2;

// Up to this exponent, the larger of the two, an object has edges of its own, beyond it only a
// silhouette.
constexpr double kMaxEdgyExponent = 1.3;

class PointSampler {
 public:
  PointSampler(const Camera& camera, const Landmark& landmark_in_camera, double spacing_px)
      : camera_(camera), landmark_(landmark_in_camera), spacing_px_(spacing_px) {}

  // Adds points along a straight segment, each in the middle of one of equal parts.
  void AddSegment(const Eigen::Vector3d& unit_start, const Eigen::Vector3d& unit_end) {
    const auto start = Project(unit_start);
    const auto end = Project(unit_end);
    if (!start || !end) return;
    const double length = (*end - *start).norm();
    // A segment shorter than the spacing carries its fraction of a point over to the next ones.
    carried_ += length / spacing_px_;
    const int count = static_cast<int>(carried_);
    carried_ -= count;
    for (int i = 0; i < count; ++i) {
      const double t = (i + 0.5) / count;
      points.push_back({unit_start + t * (unit_end - unit_start), (*end - *start) / length});
    }
  }

  std::vector<ModelPoint> points;

 private:
  std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& in_unit_body) const {
    return camera_.Project(PointAt(landmark_, in_unit_body));
  }

  const Camera& camera_;
  const Landmark& landmark_;
  double spacing_px_;
  double carried_ = 0.0;
};

void AddCuboidEdges(const Eigen::Vector3d& camera_in_unit_body, PointSampler* sampler) {
  for (const LineSegment3& edge : UnitCuboidEdges()) {
    if (IsVisibleCuboidEdge(edge, camera_in_unit_body)) sampler->AddSegment(edge[0], edge[1]);
  }
}

void AddOutline(const Camera& camera, const Landmark& landmark, PointSampler* sampler) {
  const Rigid3d object_from_camera = landmark.frame_from_object.Inverse();
  std::vector<Eigen::Vector3d> silhouette = SilhouettePoints(camera, landmark);
  for (Eigen::Vector3d& point : silhouette) {
    point = (object_from_camera * point).cwiseQuotient(landmark.half_axes);
  }
  for (size_t i = 0; i < silhouette.size(); ++i) {
    sampler->AddSegment(silhouette[i], silhouette[(i + 1) % silhouette.size()]);
  }
}

}  // namespace

std::vector<ModelPoint> VisibleModelPoints(const Camera& camera, const Landmark& landmark_in_camera,
                                           double spacing_px) {
  if (!IsInFront(landmark_in_camera)) return {};
  PointSampler sampler(camera, landmark_in_camera, spacing_px);
  const auto [of_sections, of_curve] = landmark_in_camera.shape_exponents;
  if (std::max(of_sections, of_curve) <= kMaxEdgyExponent) {
    AddCuboidEdges(CameraInUnitBody(landmark_in_camera), &sampler);
  } else {
    AddOutline(camera, landmark_in_camera, &sampler);
  }
  return std::move(sampler.points);
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
