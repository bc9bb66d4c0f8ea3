// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/multi_view.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "constraints/loss.h"
#include "geometry/direction_weights.h"
#include "initialisation/landmark_terms.h"
#include "initialisation/yaw_sweep.h"

namespace soslam {
namespace {

constexpr int kMaxRounds = 20;
constexpr double kSettled = 1e-6;  // relative change of the half axes
// Smallest eigenvalue of the normal matrix, relative to the largest, of a determined direction.
constexpr double kMinInformationShare = 1e-9;
// Smallest reciprocal condition number of systems that are solved. Below it, rounding errors
// dominate the solution.
constexpr double kMinConditionReciprocal = 1e-13;

// Normal equations in foot x, foot y, a, b, c and, if it is free, the foot's height above the
// plane.
template <int kUnknowns>
struct LinearSystem {
  using Row = Eigen::Matrix<double, kUnknowns, 1>;

  // Adds the cost weight (row . unknowns + constant)^2.
  void Add(const Row& row, double constant, double weight) {
    const Row weighted = weight * row;
    normal_matrix += weighted * row.transpose();
    right_side -= constant * weighted;
  }

  bool KnowsAllDirections() const {
    const Eigen::SelfAdjointEigenSolver<decltype(normal_matrix)> eigen(normal_matrix,
                                                                       Eigen::EigenvaluesOnly);
    const Row& information = eigen.eigenvalues();  // ascending, 1 / m^2
    return information(0) > kMinInformationShare * information(kUnknowns - 1);
  }

  std::optional<Row> Solve() const {
    const Eigen::LLT<decltype(normal_matrix)> factor(normal_matrix);
    if (factor.info() != Eigen::Success || !(factor.rcond() > kMinConditionReciprocal)) {
      return std::nullopt;
    }
    const Row unknowns = factor.solve(right_side);
    return unknowns.allFinite() ? std::optional(unknowns) : std::nullopt;
  }

  Eigen::Matrix<double, kUnknowns, kUnknowns> normal_matrix =
      Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
  Row right_side = Row::Zero();
};

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

// Adds a weak equation of each view's depth, for rays that are almost parallel: at this depth an
// object of the prior's height is as high in the image as the box.
void AddDepthsOfSize(const MultiViewObservation& observation, Eigen::Matrix3d* normal_matrix,
                     Eigen::Vector3d* right_side) {
  constexpr double kWeight = 1e-4;  // relative to a ray
  for (const BoxView& view : observation.views) {
    const Eigen::Vector3d axis =
        view.camera_from_world.rotation.conjugate() * Eigen::Vector3d::UnitZ();
    const double depth = observation.prior->height_m->median / HeightAtUnitDepth(view);
    *normal_matrix += kWeight * axis * axis.transpose();
    *right_side += kWeight * (depth - view.camera_from_world.translation.z()) * axis;
  }
}

// Least squares point (world frame) of the rays through the centres of all boxes and, as far as
// they are known, of the support plane and the depths from the size.
Eigen::Vector3d NearestToAllRays(const MultiViewObservation& observation) {
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  for (const BoxView& view : observation.views) {
    // The ray through the centre lies in the planes half-way between opposite edges.
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

// Costs that do not depend on the boxes.
LandmarkCosts PriorTerms(const MultiViewObservation& observation) {
  LandmarkCosts terms;
  const Plane& plane = observation.plane_in_world;
  if (HasRatio(observation)) terms.push_back(std::make_unique<RatioTerm>(*observation.prior));
  if (HasSize(observation)) {
    terms.push_back(
        std::make_unique<HeightTerm>(*observation.prior->height_m, observation.RestsOn()));
  }
  if (observation.scene_axis_in_world) {
    terms.push_back(std::make_unique<AxisTerm>(plane, *observation.scene_axis_in_world,
                                               observation.axes_weight));
  }
  return terms;
}

std::unique_ptr<const LandmarkTerm> TermOfView(const MultiViewObservation& observation,
                                               const BoxView& view,
                                               std::unique_ptr<const LandmarkTerm> box) {
  return std::make_unique<RobustViewTerm>(std::move(box), view.camera_from_world,
                                          observation.huber_delta, view.weight);
}

// Gauss-Newton over the views of an observation, in the foot and the half axes at a fixed yaw.
class LinearViews {
 public:
  explicit LinearViews(const MultiViewObservation& observation)
      : observation_(observation), ground_(observation.plane_in_world) {
    if (HasRatio(observation)) ratio_.emplace(*observation.prior);
    Start();
  }

  std::optional<UprightSolution> SolveAt(double yaw) const {
    Body body = start_;
    body.yaw = yaw;
    for (int round = 0; round < kMaxRounds; ++round) {
      const Eigen::Vector3d before = body.half_axes;
      const bool is_first = round == 0;
      if (!(observation_.height_is_free ? Step<6>(is_first, &body) : Step<5>(is_first, &body))) {
        return std::nullopt;
      }
      if ((body.half_axes - before).norm() < kSettled * before.norm()) break;
    }
    const Landmark landmark = LandmarkOf(body);
    for (const BoxView& view : observation_.views) {
      if (!IsInFront(Transform(view.camera_from_world, landmark))) return std::nullopt;
    }
    return UprightSolution{landmark, Cost(landmark)};
  }

 private:
  struct Body {
    double yaw = 0.0;
    Eigen::Vector2d foot;       // on the ground's x and y, m
    double height_m = 0.0;      // of the foot over the plane
    Eigen::Vector3d half_axes;  // m
  };

  // Initial guess at the point nearest to all rays, as high as the boxes.
  void Start() {
    const Eigen::Vector3d point = NearestToAllRays(observation_);
    const Eigen::Vector3d from_origin = point - ground_.origin;
    start_.foot = {from_origin.dot(ground_.x), from_origin.dot(ground_.y)};
    start_.half_axes.setOnes();
    if (observation_.prior) start_.half_axes.head<2>() = observation_.prior->ratio;
    double sum = 0.0;
    for (const BoxView& view : observation_.views) {
      const double depth = (view.camera_from_world * point).z();
      sum += 0.5 * std::abs(depth) * HeightAtUnitDepth(view);
    }
    start_.half_axes *= sum / static_cast<double>(observation_.views.size());
    start_.height_m = from_origin.dot(ground_.normal) - start_.half_axes.z();
  }

  Landmark LandmarkOf(const Body& body) const {
    UprightVector parameters;
    parameters << body.yaw, body.foot, body.half_axes.array().log().matrix();
    Landmark landmark =
        ground_.LandmarkAt(parameters, observation_.ShapeExponent(), observation_.RestsOn());
    landmark.frame_from_object.translation += body.height_m * ground_.normal;
    return landmark;
  }

  template <int kUnknowns>
  bool Step(bool is_first, Body* body) const {
    LinearSystem<kUnknowns> system;
    const Landmark landmark = LandmarkOf(*body);
    for (const BoxView& view : observation_.views)
      AddView(view, landmark, *body, is_first, &system);
    if (ratio_) AddRatio(*body, &system);
    if (HasSize(observation_)) AddSize(*body, &system);
    // Later rounds reweight, drop and add edges; Solve rejects systems that become singular.
    if (is_first && !system.KnowsAllDirections()) return false;
    const auto unknowns = system.Solve();
    if (!unknowns || !(unknowns->template segment<3>(2).minCoeff() > 0.0)) return false;
    body->foot = unknowns->template head<2>();
    body->half_axes = unknowns->template segment<3>(2);
    body->height_m = kUnknowns == 6 ? (*unknowns)(kUnknowns - 1) : 0.0;
    return true;
  }

  // Tangencies of a view's edges to first order about the body, whose tangent points are at their
  // own depths, in the first round at that of the centre.
  template <int kUnknowns>
  void AddView(const BoxView& view, const Landmark& landmark_in_world, const Body& body,
               bool is_first, LinearSystem<kUnknowns>* system) const {
    using Row = typename LinearSystem<kUnknowns>::Row;
    const Landmark landmark = Transform(view.camera_from_world, landmark_in_world);
    const Eigen::Matrix3d world_from_camera =
        view.camera_from_world.rotation.toRotationMatrix().transpose();
    Row at;
    at << body.foot, body.half_axes,
        Eigen::Matrix<double, kUnknowns - 5, 1>::Constant(body.height_m);
    for (const BoxEdge& edge : view.edges) {
      // The initial guess is too rough to decide which bounds are active and which edges are
      // outliers.
      if (is_first && edge.is_bound) continue;
      const TangentDepth depth =
          is_first ? TangentDepth{landmark.Centre().z()} : FindTangentDepth(edge, landmark);
      if (!(depth.depth_m > 0.0)) continue;
      LandmarkJacobian1 d_landmark;
      const double residual = Tangency(edge, landmark, depth, 0.0, &d_landmark);
      const double robust =
          is_first ? 1.0
                   : EvaluateLoss(ceres::HuberLoss(observation_.huber_delta), residual).weight;
      const Eigen::Vector3d d_centre = world_from_camera * d_landmark.segment<3>(3).transpose();
      const double d_height = d_centre.dot(ground_.normal);
      Row row;
      row.template head<2>() << d_centre.dot(ground_.x), d_centre.dot(ground_.y);
      row.template segment<3>(2) = d_landmark.tail<3>().transpose().cwiseQuotient(body.half_axes);
      row(4) += d_height;
      if (kUnknowns == 6) row(kUnknowns - 1) = d_height;
      system->Add(row, residual - row.dot(at), view.weight * robust);
    }
  }

  // RatioTerm to first order about the object of this height with the prior's ratios. There both
  // residuals are zero, and a derivative by a half axis is that by its logarithm divided by the
  // half axis.
  template <int kUnknowns>
  void AddRatio(const Body& body, LinearSystem<kUnknowns>* system) const {
    const Eigen::Vector3d of_prior = body.half_axes.z() * observation_.prior->ratio.homogeneous();
    for (int i = 0; i < 2; ++i) {
      typename LinearSystem<kUnknowns>::Row row = LinearSystem<kUnknowns>::Row::Zero();
      row.template segment<3>(2) =
          ratio_->d_log_half_axes.row(i).transpose().cwiseQuotient(of_prior);
      system->Add(row, 0.0, 1.0);
    }
  }

  // HeightTerm to first order about the previous height.
  template <int kUnknowns>
  void AddSize(const Body& body, LinearSystem<kUnknowns>* system) const {
    const LogNormal& height_m = *observation_.prior->height_m;
    const Eigen::Index axis = OwnHeightAxis(observation_.RestsOn());
    const double before = body.half_axes[axis];
    typename LinearSystem<kUnknowns>::Row row = LinearSystem<kUnknowns>::Row::Zero();
    row(2 + axis) = 1.0 / (height_m.log_sigma * before);
    system->Add(row, (std::log(2.0 * before / height_m.median) - 1.0) / height_m.log_sigma, 1.0);
  }

  // Without the preference of axes, which does not depend on foot and size.
  double Cost(const Landmark& landmark) const {
    double cost = 0.0;
    for (const BoxView& view : observation_.views) {
      const Landmark in_camera = Transform(view.camera_from_world, landmark);
      cost += TermOfView(observation_, view, std::make_unique<BoxTerm>(view.edges, in_camera))
                  ->Value(landmark);
    }
    if (ratio_) cost += RatioTerm(*observation_.prior).Value(landmark);
    if (HasSize(observation_))
      cost += HeightTerm(*observation_.prior->height_m, observation_.RestsOn()).Value(landmark);
    return cost;
  }

  const MultiViewObservation& observation_;
  UprightGround ground_;
  std::optional<RatioRows> ratio_;
  Body start_;
};

}  // namespace

MultiViewObservation MakeMultiViewObservation(const Sequence& sequence,
                                              const std::vector<int>& detections,
                                              const std::optional<ShapePrior>& prior,
                                              double detection_sigma_fraction,
                                              double view_correlation_rad, bool height_is_free,
                                              bool size_is_known,
                                              const std::optional<Plane>& plane_in_world) {
  MultiViewObservation observation;
  observation.prior = prior;
  observation.height_is_free = height_is_free;
  observation.size_is_known = size_is_known;
  const EdgeBias bias = prior ? prior->edge_bias : EdgeBias();
  for (const int index : detections) {
    const Detection& detection = sequence.detections[index];
    const Frame& frame = sequence.frames[detection.frame_index];
    const Object& object = sequence.objects[detection.object_index];
    if (plane_in_world) {
      observation.plane_in_world = *plane_in_world;
    } else if (object.plane_index != kNoPlane) {
      const SupportPlane& support = sequence.planes[object.plane_index];
      observation.plane_in_world = support.plane_in_world;
      observation.scene_axis_in_world = support.scene_axis_in_world;
    }
    observation.views.push_back({BoxEdges(sequence.CameraOf(detection), detection.box,
                                          detection.is_bound, detection_sigma_fraction, bias),
                                 frame.world_from_camera.Inverse()});
  }
  const auto weights =
      ViewWeights(sequence, detections, NearestToAllRays(observation), view_correlation_rad);
  for (size_t i = 0; i < weights.size(); ++i) observation.views[i].weight = weights[i];
  return observation;
}

std::vector<double> ViewWeights(const Sequence& sequence, const std::vector<int>& detections,
                                const Eigen::Vector3d& centre_in_world, double correlation_rad) {
  std::vector<Eigen::Vector3d> directions;
  for (const int index : detections) {
    const Detection& detection = sequence.detections[index];
    directions.push_back(centre_in_world -
                         sequence.FrameOf(detection).world_from_camera.translation);
  }
  return DirectionWeights(directions, correlation_rad);
}

LandmarkCosts ViewTerms(const MultiViewObservation& observation, const Landmark& start_in_world) {
  LandmarkCosts terms = PriorTerms(observation);
  for (const BoxView& view : observation.views) {
    const Landmark in_camera = Transform(view.camera_from_world, start_in_world);
    if (!IsInFront(in_camera)) continue;
    terms.push_back(
        TermOfView(observation, view, std::make_unique<BoxTerm>(view.edges, in_camera)));
  }
  return terms;
}

LandmarkCosts OutlineTerms(const MultiViewObservation& observation) {
  LandmarkCosts terms = PriorTerms(observation);
  for (const BoxView& view : observation.views) {
    terms.push_back(TermOfView(observation, view, std::make_unique<OutlineTerm>(view.edges)));
  }
  return terms;
}

std::optional<UprightSolution> SolveViewsAtYaw(const MultiViewObservation& observation,
                                               double yaw) {
  return LinearViews(observation).SolveAt(yaw);
}

double FirstYaw(const MultiViewObservation& observation) {
  const Eigen::Vector3d& normal = observation.plane_in_world.normal;
  const Eigen::Quaterniond& camera_from_world =
      observation.views.front().camera_from_world.rotation;
  const Eigen::Quaterniond upright_in_camera = UprightRotation(camera_from_world * normal, 0.0);
  return Yaw(normal, camera_from_world.conjugate() * upright_in_camera);
}

std::vector<UprightSolution> SweepViews(const MultiViewObservation& observation, double step) {
  const int steps = std::max(1, static_cast<int>(std::lround(std::numbers::pi / step)));
  const double first_yaw = FirstYaw(observation);
  const LinearViews views(observation);
  std::vector<std::optional<UprightSolution>> solutions;
  std::vector<double> costs;
  for (int i = 0; i < steps; ++i) {
    solutions.push_back(views.SolveAt(first_yaw + i * std::numbers::pi / steps));
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
