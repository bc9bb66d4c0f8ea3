// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/multi_view.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "constraints/landmark_terms.h"
#include "constraints/loss.h"
#include "geometry/triangulation.h"
#include "initialisation/view_weights.h"
#include "initialisation/yaw_sweep.h"

namespace soslam {
namespace {

constexpr int kMaxRounds = 20;
constexpr double kConvergenceTolerance = 1e-6;  // relative change of the half axes
// Smallest reciprocal condition number (1-norm) of the first round's system: below it, the boxes do
// not determine the body.
constexpr double kMinConditionReciprocal = 1e-9;
// The same of later rounds, which reweight, drop and add edges: below it, rounding errors dominate
// the solution.
constexpr double kMinLaterConditionReciprocal = 1e-13;

// Normal equations in foot x, foot y, a, b, c and the foot's height above the plane.
struct LinearSystem {
  using Row = Eigen::Matrix<double, 6, 1>;
  using Matrix = Eigen::Matrix<double, 6, 6>;

  // Adds the cost weight (row . unknowns + constant)^2.
  void Add(const Row& row, double constant, double weight) {
    const Row weighted = weight * row;
    normal_matrix += weighted * row.transpose();
    right_side -= constant * weighted;
  }

  // A height of zero, without effect on the condition of the other unknowns.
  void FixHeight() { normal_matrix(5, 5) = normal_matrix(4, 4); }

  std::optional<Row> Solve(double min_condition_reciprocal) const {
    const Eigen::LLT<Matrix> factor(normal_matrix);
    if (factor.info() != Eigen::Success || !(factor.rcond() > min_condition_reciprocal)) {
      return std::nullopt;
    }
    const Row unknowns = factor.solve(right_side);
    return unknowns.allFinite() ? std::optional(unknowns) : std::nullopt;
  }

  Matrix normal_matrix = Matrix::Zero();
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
void AddDepthsOfSize(const MultiViewObservation& observation, PointOnPlanes* point) {
  constexpr double kWeight = 1e-4;  // relative to a ray
  for (const BoxView& view : observation.views) {
    const Eigen::Vector3d axis =
        view.camera_from_world.rotation.conjugate() * Eigen::Vector3d::UnitZ();
    const double depth = observation.prior->height_m->median / HeightAtUnitDepth(view);
    point->Add({axis, view.camera_from_world.translation.z() - depth}, kWeight);
  }
}

// Least squares point (world frame) of the rays through the centres of all boxes and, as far as
// they are known, of the support plane and the depths from the size.
Eigen::Vector3d NearestToAllRays(const MultiViewObservation& observation) {
  PointOnPlanes point;
  for (const BoxView& view : observation.views) {
    // The ray through the centre lies in the planes half-way between opposite edges.
    for (const size_t i : {0, 1}) {
      const Eigen::Vector3d middle = view.edges[i].plane - view.edges[i + 2].plane;
      point.Add({view.camera_from_world.rotation.conjugate() * middle.normalized(),
                 middle.normalized().dot(view.camera_from_world.translation)});
    }
  }
  if (HasSize(observation)) AddDepthsOfSize(observation, &point);
  if (!observation.height_is_free) point.Add(observation.plane_in_world);
  return point.Solve();
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
      : observation_(observation),
        ground_(observation.plane_in_world),
        loss_(observation.huber_delta) {
    if (HasRatio(observation)) ratio_.emplace(*observation.prior);
    Start();
  }

  std::optional<UprightSolution> SolveAt(double yaw) const {
    Body body = start_;
    body.yaw = yaw;
    for (int round = 0; round < kMaxRounds; ++round) {
      const Eigen::Vector3d before = body.half_axes;
      const bool is_first = round == 0;
      if (!Step(is_first, &body)) return std::nullopt;
      if ((body.half_axes - before).norm() < kConvergenceTolerance * before.norm()) break;
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
        ground_.LandmarkAt(parameters, observation_.Exponents(), observation_.RestsOn());
    landmark.frame_from_object.translation += body.height_m * ground_.normal;
    return landmark;
  }

  bool Step(bool is_first, Body* body) const {
    LinearSystem system;
    const Landmark landmark = LandmarkOf(*body);
    for (const BoxView& view : observation_.views)
      AddView(view, landmark, *body, is_first, &system);
    if (ratio_) AddRatio(*body, &system);
    if (HasSize(observation_)) AddSize(*body, &system);
    if (!observation_.height_is_free) system.FixHeight();
    const auto unknowns =
        system.Solve(is_first ? kMinConditionReciprocal : kMinLaterConditionReciprocal);
    if (!unknowns || !(unknowns->segment<3>(2).minCoeff() > 0.0)) return false;
    body->foot = unknowns->head<2>();
    body->half_axes = unknowns->segment<3>(2);
    body->height_m = (*unknowns)(5);
    return true;
  }

  // Tangencies of a view's edges to first order about the body, whose tangent points are at their
  // own depths, in the first round at that of the centre.
  void AddView(const BoxView& view, const Landmark& landmark_in_world, const Body& body,
               bool is_first, LinearSystem* system) const {
    const Landmark landmark = Transform(view.camera_from_world, landmark_in_world);
    const Eigen::Matrix3d world_from_camera =
        view.camera_from_world.rotation.toRotationMatrix().transpose();
    LinearSystem::Row at;
    at << body.foot, body.half_axes, body.height_m;
    for (const BoxEdge& edge : view.edges) {
      // The initial guess is too rough to decide which one-sided edges are active and which edges
      // are outliers.
      if (is_first && edge.is_one_sided) continue;
      LandmarkJacobian1 d_landmark;
      std::optional<double> residual;
      if (!is_first) {
        residual = TangencyAtOwnDepth(edge, landmark, &d_landmark);
      } else if (landmark.Centre().z() > 0.0) {
        residual = Tangency(edge, landmark, {landmark.Centre().z()}, 0.0, &d_landmark);
      }
      if (!residual) continue;
      const double robust = is_first ? 1.0 : EvaluateLoss(loss_, *residual).weight;
      const Eigen::Vector3d d_centre = world_from_camera * d_landmark.segment<3>(3).transpose();
      const double d_height = d_centre.dot(ground_.normal);
      LinearSystem::Row row;
      row.head<2>() << d_centre.dot(ground_.x), d_centre.dot(ground_.y);
      row.segment<3>(2) = d_landmark.tail<3>().transpose().cwiseQuotient(body.half_axes);
      row(4) += d_height;
      row(5) = observation_.height_is_free ? d_height : 0.0;
      system->Add(row, *residual - row.dot(at), view.weight * robust);
    }
  }

  // RatioTerm to first order about the object of this height with the prior's ratios. There both
  // residuals are zero, and a derivative by a half axis is that by its logarithm divided by the
  // half axis.
  void AddRatio(const Body& body, LinearSystem* system) const {
    const Eigen::Vector3d of_prior = body.half_axes.z() * observation_.prior->ratio.homogeneous();
    for (int i = 0; i < 2; ++i) {
      LinearSystem::Row row = LinearSystem::Row::Zero();
      row.segment<3>(2) = ratio_->d_log_half_axes.row(i).transpose().cwiseQuotient(of_prior);
      system->Add(row, 0.0, 1.0);
    }
  }

  // HeightTerm to first order about the previous height.
  void AddSize(const Body& body, LinearSystem* system) const {
    const LogNormal& height_m = *observation_.prior->height_m;
    const Eigen::Index axis = OwnHeightAxis(observation_.RestsOn());
    const double before = body.half_axes[axis];
    LinearSystem::Row row = LinearSystem::Row::Zero();
    row(2 + axis) = 1.0 / (height_m.log_sigma * before);
    system->Add(row, HeightResidual(height_m, before) - row(2 + axis) * before, 1.0);
  }

  // Without the preference of axes, which does not depend on foot and size.
  double Cost(const Landmark& landmark) const {
    double cost = 0.0;
    for (const BoxView& view : observation_.views) {
      const Landmark in_camera = Transform(view.camera_from_world, landmark);
      for (const BoxEdge& edge : view.edges) {
        const auto residual = TangencyAtOwnDepth(edge, in_camera, nullptr);
        if (!residual) return std::numeric_limits<double>::infinity();
        cost += view.weight * EvaluateLoss(loss_, *residual).cost;
      }
    }
    if (ratio_) cost += RatioTerm(*observation_.prior).Value(landmark);
    if (HasSize(observation_))
      cost += HeightTerm(*observation_.prior->height_m, observation_.RestsOn()).Value(landmark);
    return cost;
  }

  const MultiViewObservation& observation_;
  UprightGround ground_;
  std::optional<RatioRows> ratio_;
  ceres::HuberLoss loss_;
  Body start_;
};

}  // namespace

MultiViewObservation MakeMultiViewObservation(const Sequence& sequence,
                                              const std::vector<int>& detections,
                                              const std::optional<ShapePrior>& prior,
                                              double detection_sigma_fraction) {
  MultiViewObservation observation;
  observation.prior = prior;
  const EdgeBias bias = prior ? prior->edge_bias : EdgeBias();
  for (const int index : detections) {
    const Detection& detection = sequence.detections[index];
    const Frame& frame = sequence.frames[detection.frame_index];
    const Object& object = sequence.objects[detection.object_index];
    if (object.plane_index != kNoPlane) {
      const SupportPlane& support = sequence.planes[object.plane_index];
      observation.plane_in_world = support.plane_in_world;
      observation.scene_axis_in_world = support.scene_axis_in_world;
    }
    observation.views.push_back({BoxEdges(sequence.CameraOf(detection), detection.box,
                                          detection.is_one_sided, detection_sigma_fraction, bias),
                                 frame.world_from_camera.Inverse()});
  }
  return observation;
}

void WeighViews(double correlation_rad, MultiViewObservation* observation) {
  const Eigen::Vector3d centre = NearestToAllRays(*observation);
  std::vector<Eigen::Vector3d> directions;
  for (const BoxView& view : observation->views) {
    directions.push_back(centre - view.camera_from_world.Inverse().translation);
  }
  const auto weights = DirectionWeights(directions, correlation_rad);
  for (size_t i = 0; i < weights.size(); ++i) observation->views[i].weight = weights[i];
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
