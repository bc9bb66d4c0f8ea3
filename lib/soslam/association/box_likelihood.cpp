// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/box_likelihood.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "soslam/constraints/landmark_terms.h"
#include "soslam/geometry/angles.h"

namespace soslam {

Drift::Drift(const std::vector<Frame>& frames, double rotation_sigma_rad,
             double translation_sigma_m)
    : rotation_variance_(rotation_sigma_rad * rotation_sigma_rad),
      translation_variance_(translation_sigma_m * translation_sigma_m),
      origin_(frames.empty() ? Eigen::Vector3d::Zero() : frames[0].world_from_camera.translation),
      position_sums_(1, Eigen::Vector3d::Zero()),
      product_sums_(1, Eigen::Matrix3d::Zero()) {
  for (const Frame& frame : frames) {
    const Eigen::Vector3d position = frame.world_from_camera.translation - origin_;
    position_sums_.push_back(position_sums_.back() + position);
    product_sums_.push_back(product_sums_.back() + position * position.transpose());
  }
}

Eigen::Matrix3d Drift::PointCovariance(int frame_index, int other_frame_index,
                                       const Eigen::Vector3d& point_in_world) const {
  const auto [first, last] = std::minmax(frame_index, other_frame_index);
  // The motions between the two frames end at the frames first + 1 to last.
  const auto begin = static_cast<size_t>(first) + 1;
  const auto end = static_cast<size_t>(last) + 1;
  const double motions = last - first;
  const Eigen::Vector3d point = point_in_world - origin_;
  const Eigen::Vector3d positions = position_sums_[end] - position_sums_[begin];
  const Eigen::Matrix3d levers = motions * point * point.transpose() -
                                 point * positions.transpose() - positions * point.transpose() +
                                 product_sums_[end] - product_sums_[begin];
  // The sum of |lever|^2 I - lever lever^T, which is -Skew(lever)^2.
  return translation_variance_ * motions * Eigen::Matrix3d::Identity() +
         rotation_variance_ * (levers.trace() * Eigen::Matrix3d::Identity() - levers);
}

namespace {

constexpr double kNoHuber = std::numeric_limits<double>::infinity();

// Gate in standard deviations: if more than one edge is farther off, an unseen object is always
// more likely. For images of 10^5 x 10^5 px CostOfAnyBox is 91, less than the square of this.
constexpr double kReach = 10.0;

Eigen::Vector4d Outwards(const Box& box) { return {-box.x_min, -box.y_min, box.x_max, box.y_max}; }

// Normal density of a subset of the edges (px).
struct NormalDensity {
  double cost;  // -2 log of the density
  double distance;
};

NormalDensity ComputeDensity(const Eigen::Vector4d& all_residuals,
                             const Eigen::Matrix4d& all_covariance, const std::vector<int>& edges) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;
  const Matrix covariance = all_covariance(edges, edges);
  const Vector residuals = all_residuals(edges);
  const Matrix lower = covariance.llt().matrixL();
  const double squared_distance =
      lower.triangularView<Eigen::Lower>().solve(residuals).squaredNorm();
  double cost = squared_distance;
  for (size_t i = 0; i < edges.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    cost += std::log(2.0 * std::numbers::pi * lower(row, row) * lower(row, row));
  }
  return {cost, std::sqrt(squared_distance)};
}

}  // namespace

BoxLikelihood::BoxLikelihood(const Sequence& sequence, const AssociateOptions& options)
    : sequence_(sequence),
      options_(options),
      drift_(sequence.frames, options.odometry_rotation_sigma_deg * kRadPerDeg,
             options.odometry_translation_sigma_m) {}

std::optional<Prediction> BoxLikelihood::Predict(const FittedObject& object, int known_frame_index,
                                                 int frame_index, const EdgeBias& bias) const {
  const Frame& frame = sequence_.frames[frame_index];
  Prediction prediction;
  prediction.feet_are_hidden = object.feet_are_hidden;
  prediction.edge_bias = bias;
  prediction.camera_from_world = frame.world_from_camera.Inverse();
  prediction.landmark_in_camera = Transform(prediction.camera_from_world, object.landmark_in_world);
  const Camera& camera = sequence_.CameraOf(frame);
  const auto outline = OutlineBox(camera, prediction.landmark_in_camera);
  if (!outline) return std::nullopt;
  prediction.outline = *outline;
  Covariance9 covariance = object.covariance;
  covariance.block<3, 3>(3, 3) +=
      drift_.PointCovariance(known_frame_index, frame_index, object.landmark_in_world.Centre());
  // The box equals the outline, so the Jacobian of BoxTerm is that of the outline's edges.
  const auto edges = BoxEdges(camera, prediction.outline, {}, 1.0);
  const RobustViewTerm term(std::make_unique<BoxTerm>(edges, prediction.landmark_in_camera),
                            prediction.camera_from_world, kNoHuber, 1.0);
  Eigen::VectorXd residuals(4);
  LandmarkTerm::Jacobian d_landmark(4, kLandmarkDof);
  term.Evaluate(object.landmark_in_world, residuals, &d_landmark);
  for (size_t i = 0; i < edges.size(); ++i) {
    d_landmark.row(static_cast<Eigen::Index>(i)) *= edges[i].sigma_px;
  }
  prediction.outline_covariance.noalias() = d_landmark * covariance * d_landmark.transpose();
  return prediction;
}

std::optional<BoxMatch> BoxLikelihood::Match(const Prediction& prediction,
                                             const Detection& detection) const {
  const EdgeBias& bias = prediction.edge_bias;
  const Box box = WithoutBias(detection.box, detection.is_one_sided, bias);
  const auto edges = BoxEdges(sequence_.CameraOf(detection), detection.box, detection.is_one_sided,
                              options_.upright.detection_sigma_fraction, bias);
  // The distance (px) that the predicted outline extends beyond each box edge.
  Eigen::Vector4d residuals = Outwards(prediction.outline) - Outwards(box);
  Eigen::Matrix4d covariance = prediction.outline_covariance;
  for (size_t i = 0; i < edges.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (edges[i].is_one_sided && residuals[row] > 0.0) {
      residuals[row] = 0.0;
      covariance.row(row).setZero();
      covariance.col(row).setZero();
    }
    covariance(row, row) += edges[i].sigma_px * edges[i].sigma_px;
  }
  const Eigen::Array4d reach = kReach * covariance.diagonal().array().sqrt();
  if ((residuals.array().abs() > reach).count() > 1) return std::nullopt;
  const double p = options_.cut_edge_probability;
  BoxMatch best;
  best.overlap = BoxOverlap(prediction.outline, box);
  const NormalDensity whole = ComputeDensity(residuals, covariance, {0, 1, 2, 3});
  best.cost = whole.cost - 2.0 * std::log(1.0 - 4.0 * p);
  best.distance = whole.distance;
  for (int cut = 0; cut < 4; ++cut) {
    const double p_cut = cut == 3 && prediction.feet_are_hidden ? kHiddenFeetInView : p;
    if (p_cut == 0.0) continue;
    std::vector<int> others = {0, 1, 2, 3};
    std::erase(others, cut);
    const NormalDensity rest = ComputeDensity(residuals, covariance, others);
    const double extent_px =
        cut % 2 == 0 ? prediction.outline.Width() : prediction.outline.Height();
    const double cost = rest.cost - 2.0 * std::log(p_cut / extent_px);
    if (cost < best.cost) best = {best.overlap, rest.distance, BoxSide(cut), cost};
  }
  return best;
}

double BoxLikelihood::CostOfAnyBox(const Detection& detection) const {
  const double width = sequence_.CameraOf(detection).width;
  const double height = sequence_.CameraOf(detection).height;
  // Left and right edge are uniform over the image with left < right; top and bottom likewise.
  return 2.0 * std::log(0.5 * width * width * 0.5 * height * height);
}

}  // namespace soslam
