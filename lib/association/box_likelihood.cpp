// SPDX-License-Identifier: BSD-3-Clause
#include "association/box_likelihood.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "constraints/tangency.h"
#include "initialisation/upright.h"

namespace soslam {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kNoHuber = std::numeric_limits<double>::infinity();

// A box whose edges, but for one, are not within so many standard deviations is explained better by
// any object at all: images of 10^5 x 10^5 px have CostOfAnyBox 91, less than the square of this.
constexpr double kReach = 10.0;

// How far the body reaches beyond each edge (px / sigma), and the covariance of that.
struct Innovation {
  Eigen::Vector4d residuals;
  Eigen::Matrix4d covariance;
  Eigen::Vector4d sigmas_px;
};

Innovation InnovationOf(const Prediction& prediction, const std::array<BoxEdge, 4>& edges) {
  const Landmark& landmark = prediction.object->landmark_in_world;
  const RobustViewTerm term(std::make_unique<BoxTerm>(edges, prediction.landmark_in_camera),
                            prediction.camera_from_world, kNoHuber, 1.0);
  Eigen::VectorXd residuals(4);
  LandmarkTerm::Jacobian by_landmark(4, kLandmarkDof);
  term.Evaluate(landmark, residuals, &by_landmark);
  const Eigen::Matrix<double, 4, 3> by_centre = by_landmark.middleCols<3>(3);
  Innovation innovation;
  innovation.residuals = residuals;
  innovation.covariance = Eigen::Matrix4d::Identity() +
                          by_landmark * prediction.object->covariance * by_landmark.transpose() +
                          by_centre * prediction.drift_covariance * by_centre.transpose();
  for (size_t i = 0; i < edges.size(); ++i) {
    innovation.sigmas_px[static_cast<Eigen::Index>(i)] = edges[i].sigma_px;
  }
  return innovation;
}

// Of some edges, in px.
struct NormalDensity {
  double cost;  // -2 log
  double distance;
};

NormalDensity DensityOf(const Innovation& innovation, const std::vector<int>& edges) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;
  const Matrix covariance = innovation.covariance(edges, edges);
  const Vector residuals = innovation.residuals(edges);
  const Matrix lower = covariance.llt().matrixL();
  const double squared_distance =
      lower.triangularView<Eigen::Lower>().solve(residuals).squaredNorm();
  double cost = squared_distance;
  for (size_t i = 0; i < edges.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double deviation_px = lower(row, row) * innovation.sigmas_px[edges[i]];
    cost += std::log(2.0 * std::numbers::pi * deviation_px * deviation_px);
  }
  return {cost, std::sqrt(squared_distance)};
}

// By the sums of all that may move an edge, each at the nearest point of the body.
double MaxSpread(const Prediction& prediction, const Camera& camera) {
  const Landmark& landmark = prediction.landmark_in_camera;
  const Covariance9& covariance = prediction.object->covariance;
  const double radius = landmark.half_axes.norm();
  const auto sigma = [](const Eigen::Matrix3d& block) {
    return std::sqrt(std::max(0.0, block.trace()));
  };
  const double sum_m =
      sigma(prediction.drift_covariance) + sigma(covariance.block<3, 3>(3, 3)) +
      radius * (sigma(covariance.block<3, 3>(0, 0)) + sigma(covariance.block<3, 3>(6, 6)));
  const double depth = std::max(landmark.Centre().z() - radius, 0.1 * landmark.Centre().z());
  return std::max(camera.fx, camera.fy) / depth * sum_m;
}

bool IsOutOfReach(const Prediction& prediction, const Detection& detection,
                  const std::array<BoxEdge, 4>& edges) {
  const Box& expected = prediction.outline;
  const Box& box = detection.box;
  const std::array<double, 4> offsets_px = {expected.x_min - box.x_min, expected.y_min - box.y_min,
                                            expected.x_max - box.x_max, expected.y_max - box.y_max};
  int far = 0;
  for (size_t i = 0; i < edges.size(); ++i) {
    const double reach_px = kReach * std::hypot(edges[i].sigma_px, prediction.max_spread_px);
    if (!edges[i].is_bound && std::abs(offsets_px[i]) > reach_px) ++far;
  }
  return far > 1;
}

}  // namespace

double BoxOverlap(const Box& one, const Box& other) {
  const double width = std::min(one.x_max, other.x_max) - std::max(one.x_min, other.x_min);
  const double height = std::min(one.y_max, other.y_max) - std::max(one.y_min, other.y_min);
  if (!(width > 0.0) || !(height > 0.0)) return 0.0;
  const double both = width * height;
  return both / (one.Width() * one.Height() + other.Width() * other.Height() - both);
}

BoxLikelihood::BoxLikelihood(const Sequence& sequence, const AssociateOptions& options)
    : sequence_(sequence),
      options_(options),
      drift_(sequence.frames, options.odometry_rotation_sigma_deg * kRadians,
             options.odometry_translation_sigma_m) {}

std::optional<Prediction> BoxLikelihood::Predict(const FittedObject& object, int known_frame_index,
                                                 int frame_index) const {
  const Frame& frame = sequence_.frames[static_cast<size_t>(frame_index)];
  Prediction prediction;
  prediction.object = &object;
  prediction.camera_from_world = frame.world_from_camera.Inverse();
  prediction.landmark_in_camera = Transform(prediction.camera_from_world, object.landmark_in_world);
  const Camera& camera = sequence_.CameraOf(frame);
  const auto outline = OutlineBox(camera, prediction.landmark_in_camera);
  if (!outline) return std::nullopt;
  prediction.outline = *outline;
  prediction.drift_covariance =
      drift_.PointCovariance(known_frame_index, frame_index, object.landmark_in_world.Centre());
  prediction.max_spread_px = MaxSpread(prediction, camera);
  return prediction;
}

std::optional<Explanation> BoxLikelihood::Explain(const Prediction& prediction,
                                                  const Detection& detection) const {
  const auto edges = BoxEdges(sequence_.CameraOf(detection), detection.box, detection.is_bound,
                              options_.box_sigma_fraction);
  if (IsOutOfReach(prediction, detection, edges)) return std::nullopt;
  const Innovation innovation = InnovationOf(prediction, edges);
  const double p = options_.cut_edge_probability;
  Explanation best;
  best.overlap = BoxOverlap(prediction.outline, detection.box);
  const NormalDensity whole = DensityOf(innovation, {0, 1, 2, 3});
  best.cost = whole.cost - 2.0 * std::log(1.0 - 4.0 * p);
  best.distance = whole.distance;
  for (int cut = 0; cut < 4 && p > 0.0; ++cut) {
    std::vector<int> others = {0, 1, 2, 3};
    std::erase(others, cut);
    const NormalDensity rest = DensityOf(innovation, others);
    const double extent_px =
        cut % 2 == 0 ? prediction.outline.Width() : prediction.outline.Height();
    const double cost = rest.cost - 2.0 * std::log(p / extent_px);
    if (cost < best.cost) best = {best.overlap, rest.distance, cut, cost};
  }
  return best;
}

double BoxLikelihood::CostOfAnyBox(const Detection& detection) const {
  const double width = sequence_.CameraOf(detection).width;
  const double height = sequence_.CameraOf(detection).height;
  // Left and right edge anywhere in the image, in this order; so top and bottom.
  return 2.0 * std::log(0.5 * width * width * 0.5 * height * height);
}

}  // namespace soslam
