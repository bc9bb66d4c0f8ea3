// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/multi_view.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "initialisation/view_weights.h"
#include "initialisation/yaw_sweep.h"

namespace soslam {
namespace {

constexpr int kMaxRounds = 20;
constexpr double kSettled = 1e-6;  // relative change of the half axes
// A direction that is known so much less than the best known one is not known at all.
constexpr double kMinInformationShare = 1e-9;

// Foot x, foot y, a, b, c and, where it is free, the foot's height over the plane.
constexpr int kMaxUnknowns = 6;
using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxUnknowns, 1>;
using NormalMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxUnknowns, kMaxUnknowns>;

bool HasRatio(const MultiViewObservation& observation) {
  return observation.prior && !observation.ratio_is_free;
}

bool HasSize(const MultiViewObservation& observation) {
  return observation.size_is_known && observation.prior && observation.prior->height_m;
}

double HeightAtUnitDepth(const BoxView& view) {
  const Eigen::Vector3d height = view.edges[1].plane + view.edges[3].plane;
  return std::abs(height.z() / view.edges[3].plane.y());
}

// Where rays hardly cross, a body of the prior's height is as high in the image as the boxes are.
void AddDepthsOfSize(const MultiViewObservation& observation, Eigen::Matrix3d* normal_matrix,
                     Eigen::Vector3d* right_side) {
  constexpr double kWeight = 1e-4;  // of a ray
  for (const BoxView& view : observation.views) {
    const Eigen::Vector3d axis =
        view.camera_from_world.rotation.conjugate() * Eigen::Vector3d::UnitZ();
    const double depth = observation.prior->height_m->median / HeightAtUnitDepth(view);
    *normal_matrix += kWeight * axis * axis.transpose();
    *right_side += kWeight * (depth - view.camera_from_world.translation.z()) * axis;
  }
}

// The point nearest to the rays through the middles of all boxes.
Eigen::Vector3d NearestToAllRays(const MultiViewObservation& observation) {
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  for (const BoxView& view : observation.views) {
    // The middle lies on the planes half-way between opposite edges.
    for (const size_t i : {0, 1}) {
      const Eigen::Vector3d middle = view.edges[i].plane - view.edges[i + 2].plane;
      const Eigen::Vector3d normal =
          view.camera_from_world.rotation.conjugate() * middle.normalized();
      const double offset = middle.normalized().dot(view.camera_from_world.translation);
      normal_matrix += normal * normal.transpose();
      right_side -= offset * normal;
    }
  }
  if (HasSize(observation)) AddDepthsOfSize(observation, &normal_matrix, &right_side);
  if (!observation.height_is_free) {
    const Plane& plane = observation.plane_in_world;
    normal_matrix += plane.normal * plane.normal.transpose();
    right_side -= plane.offset * plane.normal;
  }
  return normal_matrix.completeOrthogonalDecomposition().solve(right_side);
}

double CostOf(const LandmarkTerm& prior, const Landmark& landmark) {
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1> residuals(prior.NumResiduals());
  prior.Evaluate(landmark, residuals, nullptr);
  return 0.5 * residuals.squaredNorm();
}

class LinearViews {
 public:
  LinearViews(const MultiViewObservation& observation, double yaw)
      : observation_(observation),
        world_from_object_(UprightRotation(observation.plane_in_world.normal, yaw)),
        x_(UprightRotation(observation.plane_in_world.normal, 0.0) * Eigen::Vector3d::UnitX()),
        y_(observation.plane_in_world.normal.cross(x_)) {
    Start();
  }

  std::optional<UprightSolution> Solve() {
    for (int round = 0; round < kMaxRounds; ++round) {
      const Eigen::Vector3d before = landmark_.half_axes;
      if (!Step(/*is_first=*/round == 0)) return std::nullopt;
      if ((landmark_.half_axes - before).norm() < kSettled * before.norm()) break;
    }
    for (const BoxView& view : observation_.views) {
      if (!IsInFront(Transform(view.camera_from_world, landmark_))) return std::nullopt;
    }
    return UprightSolution{landmark_, Cost()};
  }

 private:
  // As large as the boxes are high, where their rays meet.
  void Start() {
    const Eigen::Vector3d point = NearestToAllRays(observation_);
    Eigen::Vector3d proportions = Eigen::Vector3d::Ones();
    if (observation_.prior) proportions.head<2>() = observation_.prior->ratio;
    landmark_.frame_from_object = {world_from_object_, point};
    landmark_.half_axes = proportions;
    landmark_.shape_exponent = observation_.ShapeExponent();
    double sum = 0.0;
    for (const BoxView& view : observation_.views) {
      const double depth = (view.camera_from_world * point).z();
      sum += 0.5 * std::abs(depth) * HeightAtUnitDepth(view);
    }
    landmark_.half_axes *= sum / static_cast<double>(observation_.views.size());
  }

  Eigen::Index NumUnknowns() const { return observation_.height_is_free ? 6 : 5; }

  bool Step(bool is_first) {
    NormalMatrix normal_matrix = NormalMatrix::Zero(NumUnknowns(), NumUnknowns());
    Unknowns right_side = Unknowns::Zero(NumUnknowns());
    const auto add = [&](const Unknowns& row, double constant, double weight) {
      normal_matrix += weight * row * row.transpose();
      right_side -= weight * constant * row;
    };
    for (const BoxView& view : observation_.views) {
      const Landmark in_camera = Transform(view.camera_from_world, landmark_);
      for (const BoxEdge& edge : view.edges) AddEdge(view, edge, in_camera, is_first, add);
    }
    if (HasRatio(observation_)) AddRatio(add);
    if (HasSize(observation_)) AddSize(add);
    const Eigen::SelfAdjointEigenSolver<NormalMatrix> eigen(normal_matrix);
    const Unknowns& information = eigen.eigenvalues();  // ascending, 1 / m^2
    if (!(information(0) > kMinInformationShare * information(NumUnknowns() - 1))) return false;
    const Unknowns unknowns = eigen.eigenvectors() * information.cwiseInverse().asDiagonal() *
                              eigen.eigenvectors().transpose() * right_side;
    if (!unknowns.allFinite() || !(unknowns.segment<3>(2).minCoeff() > 0.0)) return false;
    const Plane& plane = observation_.plane_in_world;
    landmark_.half_axes = unknowns.segment<3>(2);
    const double height = observation_.height_is_free ? unknowns(5) : 0.0;
    landmark_.frame_from_object.translation =
        unknowns(0) * x_ + unknowns(1) * y_ + (unknowns(4) + height - plane.offset) * plane.normal;
    return true;
  }

  template <typename Add>
  void AddEdge(const BoxView& view, const BoxEdge& edge, const Landmark& in_camera, bool is_first,
               const Add& add) const {
    const double start_depth = in_camera.Centre().z();
    const double depth = is_first ? start_depth : TangentDepth(edge, in_camera);
    if (!(depth > 0.0)) return;
    const double residual = Tangency(edge, in_camera, depth, 0.0, nullptr);
    // Where the body is at first says nothing about what a bound allows, and who is an outlier.
    if (edge.is_bound && (is_first || residual == 0.0)) return;
    const double size = std::abs(residual);
    const double robust =
        is_first || size <= observation_.huber_delta ? 1.0 : observation_.huber_delta / size;
    const Plane& plane = observation_.plane_in_world;
    const Eigen::Vector3d normal = view.camera_from_world.rotation.conjugate() * edge.plane;
    const SupportValue support = SupportFunction(landmark_.half_axes, landmark_.shape_exponent,
                                                 world_from_object_.conjugate() * normal);
    Unknowns row(NumUnknowns());
    row.head<5>() << normal.dot(x_), normal.dot(y_),
        support.by_log_half_axes.cwiseQuotient(landmark_.half_axes);
    row(4) += normal.dot(plane.normal);
    if (observation_.height_is_free) row(5) = normal.dot(plane.normal);
    const double constant = edge.plane.dot(view.camera_from_world.translation) -
                            plane.offset * normal.dot(plane.normal);
    const double scale = 1.0 / (depth * edge.sigma_px);
    add(scale * row, scale * constant, view.weight * robust);
  }

  // As RatioTerm: log(s / (r c)) is (s - r c) / (r c) to first order, the second one given the
  // first.
  template <typename Add>
  void AddRatio(const Add& add) const {
    const ShapePrior& prior = *observation_.prior;
    std::array<Unknowns, 2> rows;
    for (int i = 0; i < 2; ++i) {
      const double scale = 1.0 / (prior.log_sigma[i] * prior.ratio[i] * landmark_.half_axes.z());
      rows[static_cast<size_t>(i)] = Unknowns::Zero(NumUnknowns());
      rows[static_cast<size_t>(i)](2 + i) = scale;
      rows[static_cast<size_t>(i)](4) = -scale * prior.ratio[i];
    }
    const double unexplained = std::sqrt(1.0 - prior.log_correlation * prior.log_correlation);
    add(rows[0], 0.0, 1.0);
    add((rows[1] - prior.log_correlation * rows[0]) / unexplained, 0.0, 1.0);
  }

  // As HeightTerm: to first order about the height before.
  template <typename Add>
  void AddSize(const Add& add) const {
    const LogNormal& height_m = *observation_.prior->height_m;
    const double before = landmark_.half_axes.z();
    Unknowns row = Unknowns::Zero(NumUnknowns());
    row(4) = 1.0 / (height_m.log_sigma * before);
    add(row, (std::log(2.0 * before / height_m.median) - 1.0) / height_m.log_sigma, 1.0);
  }

  double Cost() const {
    double cost = 0.0;
    for (const BoxView& view : observation_.views) {
      const Landmark in_camera = Transform(view.camera_from_world, landmark_);
      for (const BoxEdge& edge : view.edges) {
        const double size =
            std::abs(Tangency(edge, in_camera, TangentDepth(edge, in_camera), 0.0, nullptr));
        const double delta = observation_.huber_delta;
        cost += view.weight * (size <= delta ? 0.5 * size * size : delta * (size - 0.5 * delta));
      }
    }
    if (HasRatio(observation_)) cost += CostOf(RatioTerm(*observation_.prior), landmark_);
    if (HasSize(observation_)) cost += CostOf(HeightTerm(*observation_.prior->height_m), landmark_);
    return cost;
  }

  const MultiViewObservation& observation_;
  Eigen::Quaterniond world_from_object_;
  Eigen::Vector3d x_;
  Eigen::Vector3d y_;
  Landmark landmark_;
};

// What is known of the body without its boxes.
LandmarkTerms PriorTerms(const MultiViewObservation& observation) {
  LandmarkTerms terms;
  const Plane& plane = observation.plane_in_world;
  if (HasRatio(observation)) terms.push_back(std::make_unique<RatioTerm>(*observation.prior));
  if (HasSize(observation)) {
    terms.push_back(std::make_unique<HeightTerm>(*observation.prior->height_m));
  }
  terms.push_back(std::make_unique<AxisTerm>(plane, WorldAxis(plane), observation.axes_weight));
  return terms;
}

std::unique_ptr<const LandmarkTerm> TermOfView(const MultiViewObservation& observation,
                                               const BoxView& view,
                                               std::unique_ptr<const LandmarkTerm> box) {
  return std::make_unique<RobustViewTerm>(std::move(box), view.camera_from_world,
                                          observation.huber_delta, view.weight);
}

}  // namespace

MultiViewObservation MakeMultiViewObservation(const Sequence& sequence,
                                              const std::vector<int>& detections,
                                              const std::optional<ShapePrior>& prior,
                                              double detection_sigma_fraction,
                                              double view_correlation_rad, bool height_is_free,
                                              bool size_is_known) {
  MultiViewObservation observation;
  observation.prior = prior;
  observation.height_is_free = height_is_free;
  observation.size_is_known = size_is_known;
  for (const int index : detections) {
    const Detection& detection = sequence.detections[static_cast<size_t>(index)];
    const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
    const Object& object = sequence.objects[static_cast<size_t>(detection.object_index)];
    if (object.plane_index != kNoPlane) {
      observation.plane_in_world =
          sequence.planes[static_cast<size_t>(object.plane_index)].plane_in_world;
    }
    observation.views.push_back({BoxEdges(sequence.CameraOf(detection), detection.box,
                                          detection.is_bound, detection_sigma_fraction),
                                 frame.world_from_camera.Inverse()});
  }
  const auto weights =
      ViewWeights(sequence, detections, NearestToAllRays(observation), view_correlation_rad);
  for (size_t i = 0; i < weights.size(); ++i) observation.views[i].weight = weights[i];
  return observation;
}

LandmarkTerms ViewTerms(const MultiViewObservation& observation, const Landmark& start_in_world) {
  LandmarkTerms terms = PriorTerms(observation);
  for (const BoxView& view : observation.views) {
    const Landmark in_camera = Transform(view.camera_from_world, start_in_world);
    if (!IsInFront(in_camera)) continue;
    terms.push_back(
        TermOfView(observation, view, std::make_unique<BoxTerm>(view.edges, in_camera)));
  }
  return terms;
}

LandmarkTerms OutlineTerms(const MultiViewObservation& observation) {
  LandmarkTerms terms = PriorTerms(observation);
  for (const BoxView& view : observation.views) {
    terms.push_back(TermOfView(observation, view, std::make_unique<OutlineTerm>(view.edges)));
  }
  return terms;
}

std::optional<UprightSolution> SolveViewsAtYaw(const MultiViewObservation& observation,
                                               double yaw) {
  return LinearViews(observation, yaw).Solve();
}

std::vector<UprightSolution> SweepViews(const MultiViewObservation& observation, double step) {
  const int steps = std::max(1, static_cast<int>(std::lround(std::numbers::pi / step)));
  std::vector<std::optional<UprightSolution>> solutions;
  std::vector<double> costs;
  for (int i = 0; i < steps; ++i) {
    solutions.push_back(SolveViewsAtYaw(observation, i * std::numbers::pi / steps));
    costs.push_back(solutions.back() ? solutions.back()->cost
                                     : std::numeric_limits<double>::quiet_NaN());
  }
  std::vector<UprightSolution> optima;
  for (const size_t i : CircularMinima(costs)) optima.push_back(*solutions[i]);
  return optima;
}

std::optional<UprightSolution> SolveViews(const MultiViewObservation& observation, double step) {
  std::optional<UprightSolution> best;
  for (const UprightSolution& optimum : SweepViews(observation, step)) {
    const auto solution =
        FitUpright(observation.plane_in_world, optimum.landmark,
                   ViewTerms(observation, optimum.landmark), /*yaw_is_free=*/true);
    if (solution && (!best || solution->cost < best->cost)) best = solution;
  }
  return best;
}

}  // namespace soslam
