// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/yaw_sweep.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

namespace soslam {
namespace {

// Each round takes the error of the tangent depths to a hundredth, or less.
constexpr int kMaxDepthRounds = 20;
constexpr double kDepthTolerance = 1e-10;
// Two optima closer than this are one.
constexpr double kSameYaw = 0.5 * std::numbers::pi / 180.0;
// Of a sweep's minima, those that may be the best ones when refined.
constexpr size_t kRefinedMinima = 12;
// Of the finer grid around a grid point, either way.
constexpr int kRefinementSteps = 10;
// Of the likelihood between two yaws of the grid.
constexpr int kLikelihoodSteps = 100;

// Foot x, foot y and half height c of the body with the prior's ratio, given the tangent depths.
class LinearSystem {
 public:
  LinearSystem(const UprightObservation& observation, double yaw,
               const std::array<double, 4>& depths_m)
      : observation_(observation) {
    const Plane& plane = observation.plane_in_camera;
    const Eigen::Quaterniond upright = UprightRotation(plane.normal, yaw);
    const Eigen::Vector3d x = UprightRotation(plane.normal, 0.0) * Eigen::Vector3d::UnitX();
    const Eigen::Vector3d y = plane.normal.cross(x);
    const Eigen::Vector3d origin = -plane.offset * plane.normal;
    const ShapePrior& prior = observation.prior;
    const Eigen::Vector3d proportions(prior.ratio.x(), prior.ratio.y(), 1.0);
    for (size_t i = 0; i < depths_m.size(); ++i) {
      const BoxEdge& edge = observation.edges[i];
      const double weight = 1.0 / (depths_m[i] * edge.sigma_px);
      const double extent =
          SupportFunction(proportions, prior.shape_exponent, upright.conjugate() * edge.plane)
              .extent;
      const auto row = static_cast<Eigen::Index>(i);
      matrix_.row(row) = weight * Eigen::RowVector3d(edge.plane.dot(x), edge.plane.dot(y),
                                                     edge.plane.dot(plane.normal) + extent);
      right_side_(row) = -weight * edge.plane.dot(origin);
    }
  }

  Eigen::Vector3d Solve() const {
    std::array<bool, 4> counts{};
    for (size_t i = 0; i < counts.size(); ++i) counts[i] = !observation_.edges[i].is_bound;
    Eigen::Vector3d solution = Solve(counts);
    const Eigen::Vector4d outside = matrix_ * solution - right_side_;
    bool missed = false;
    for (size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] || !(outside(static_cast<Eigen::Index>(i)) < 0.0)) continue;
      counts[i] = missed = true;
    }
    return missed ? Solve(counts) : solution;
  }

 private:
  Eigen::Vector3d Solve(const std::array<bool, 4>& counts) const {
    Eigen::Vector4d selected;
    for (size_t i = 0; i < counts.size(); ++i) {
      selected(static_cast<Eigen::Index>(i)) = counts[i] ? 1.0 : 0.0;
    }
    return (selected.asDiagonal() * matrix_)
        .colPivHouseholderQr()
        .solve(selected.asDiagonal() * right_side_);
  }

  const UprightObservation& observation_;
  Eigen::Matrix<double, 4, 3> matrix_;
  Eigen::Vector4d right_side_;
};

// Foot and size take three.
bool HasEnoughEdges(const UprightObservation& observation) {
  return std::count_if(observation.edges.begin(), observation.edges.end(),
                       [](const BoxEdge& edge) { return !edge.is_bound; }) >= 3;
}

// Fits the terms, and again those of the result. The cost is that of the result's own terms.
std::optional<UprightSolution> Fit(const UprightObservation& observation,
                                   const YawObjective& objective, const Landmark& start,
                                   bool yaw_is_free) {
  std::optional<UprightSolution> solution = UprightSolution{start, 0.0};
  for (int round = 0; round < objective.rounds; ++round) {
    solution = FitUpright(observation.plane_in_camera, solution->landmark,
                          objective.terms(solution->landmark), yaw_is_free);
    if (!solution || !IsInFront(solution->landmark)) return std::nullopt;
  }
  if (objective.rounds > 1) {
    solution->cost = TotalCost(objective.terms(solution->landmark), solution->landmark);
  }
  if (objective.extra_cost) solution->cost += objective.extra_cost(solution->landmark);
  return solution;
}

// The best landmark near a grid point. Without an extra cost the fit finds the yaw; with one a
// finer grid does.
std::optional<UprightSolution> RefineYaw(const UprightObservation& observation,
                                         const YawObjective& objective, const Landmark& start,
                                         double step) {
  if (!objective.extra_cost) return Fit(observation, objective, start, /*yaw_is_free=*/true);
  std::optional<UprightSolution> best;
  for (int i = -kRefinementSteps; i <= kRefinementSteps; ++i) {
    const auto solution = Fit(observation, objective, Turned(start, i * step / kRefinementSteps),
                              /*yaw_is_free=*/false);
    if (solution && (!best || solution->cost < best->cost)) best = solution;
  }
  return best;
}

}  // namespace

std::optional<Landmark> SolveAtYaw(const UprightObservation& observation, double yaw) {
  if (!HasEnoughEdges(observation)) return std::nullopt;
  std::array<double, 4> depths_m;
  depths_m.fill(1.0);  // as long as they are equal, their size does not matter
  Landmark landmark;
  bool settled = false;
  for (int round = 0; round < kMaxDepthRounds && !settled; ++round) {
    const Eigen::Vector3d solution = LinearSystem(observation, yaw, depths_m).Solve();
    const double c = solution.z();
    if (!solution.allFinite() || !(c > 0.0)) return std::nullopt;
    UprightVector parameters;
    const ShapePrior& prior = observation.prior;
    parameters << yaw, solution.x(), solution.y(), std::log(prior.ratio.x() * c),
        std::log(prior.ratio.y() * c), std::log(c);
    landmark = UprightLandmark(observation.plane_in_camera, parameters, prior.shape_exponent);
    if (!IsInFront(landmark)) return std::nullopt;
    settled = true;
    for (size_t i = 0; i < depths_m.size(); ++i) {
      const double depth_m = TangentDepth(observation.edges[i], landmark);
      settled = settled && std::abs(depth_m - depths_m[i]) < kDepthTolerance * depth_m;
      depths_m[i] = depth_m;
    }
  }
  return landmark;
}

std::string WhyNoSolution(const UprightObservation& observation) {
  return HasEnoughEdges(observation) ? "no_solution" : "fewer_than_three_measured_edges";
}

UprightObservation MakeUprightObservation(const Sequence& sequence, const Detection& detection,
                                          const ShapePrior& prior, const UprightOptions& options) {
  return {sequence.CameraOf(detection),
          BoxEdges(sequence.CameraOf(detection), detection.box, detection.is_bound,
                   options.detection_sigma_fraction),
          detection.plane_in_camera,
          prior,
          WorldAxisInCamera(sequence, detection),
          options.axes_weight};
}

Eigen::Vector3d WorldAxisInCamera(const Sequence& sequence, const Detection& detection) {
  const auto& object = sequence.objects[static_cast<size_t>(detection.object_index)];
  const Plane& plane = sequence.planes[static_cast<size_t>(object.plane_index)].plane_in_world;
  const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
  return frame.world_from_camera.rotation.conjugate() * WorldAxis(plane);
}

YawObjective BoxObjective(const UprightObservation& observation) {
  YawObjective objective;
  objective.terms = [&observation](const Landmark& start) {
    LandmarkTerms terms;
    terms.push_back(std::make_unique<BoxTerm>(observation.edges, start));
    terms.push_back(std::make_unique<RatioTerm>(observation.prior));
    terms.push_back(std::make_unique<AxisTerm>(
        observation.plane_in_camera, observation.world_axis_in_camera, observation.axes_weight));
    if (observation.yaw_prior) {
      terms.push_back(
          std::make_unique<YawTerm>(observation.plane_in_camera, *observation.yaw_prior));
    }
    return terms;
  };
  return objective;
}

std::vector<double> YawSweep::Costs() const {
  std::vector<double> costs;
  for (const auto& solution : solutions) {
    costs.push_back(solution ? solution->cost : std::numeric_limits<double>::quiet_NaN());
  }
  return costs;
}

double YawSweep::StandardDeviation(const std::vector<Optimum>& optima) const {
  // Nodes by their distance from the first optimum, once around. Between them the square root of
  // the cost above the lowest is linear, which holds for a Gaussian of any width.
  const double centre = optima.front().yaw;
  std::vector<std::pair<double, double>> nodes;
  for (const Optimum& optimum : optima) {
    nodes.emplace_back(YawDifferenceModuloPi(optimum.yaw, centre), optimum.cost);
  }
  for (size_t i = 0; i < yaw.size(); ++i) {
    if (!solutions[i]) continue;
    nodes.emplace_back(YawDifferenceModuloPi(yaw[i], centre), solutions[i]->cost);
  }
  std::sort(nodes.begin(), nodes.end());
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& [at, cost] : nodes) lowest = std::min(lowest, cost);
  nodes.emplace_back(nodes.front().first + std::numbers::pi, nodes.front().second);

  const double step = std::numbers::pi / static_cast<double>(yaw.size());
  double sum = 0.0;
  double squares = 0.0;
  for (size_t i = 1; i < nodes.size(); ++i) {
    const double from = nodes[i - 1].first;
    const double to = nodes[i].first;
    if (to - from > 1.5 * step) continue;  // no landmark in between
    const double from_height = std::sqrt(nodes[i - 1].second - lowest);
    const double to_height = std::sqrt(nodes[i].second - lowest);
    for (int k = 0; k < kLikelihoodSteps; ++k) {
      const double share = (k + 0.5) / kLikelihoodSteps;
      const double height = from_height + share * (to_height - from_height);
      const double mass = (to - from) * std::exp(-height * height);
      sum += mass;
      squares += mass * std::pow(YawDifferenceModuloPi(from + share * (to - from), 0.0), 2);
    }
  }
  return sum > 0.0 ? std::sqrt(squares / sum) : 0.5 * step;  // between two yaws without a landmark
}

YawSweep SweepYaw(const UprightObservation& observation, const YawObjective& objective,
                  double step) {
  YawSweep sweep;
  const int steps = std::max(1, static_cast<int>(std::lround(std::numbers::pi / step)));
  for (int i = 0; i < steps; ++i) {
    sweep.yaw.push_back(i * std::numbers::pi / steps);
    const auto start = SolveAtYaw(observation, sweep.yaw.back());
    sweep.solutions.push_back(start ? Fit(observation, objective, *start, /*yaw_is_free=*/false)
                                    : std::nullopt);
  }
  return sweep;
}

std::vector<size_t> CircularMinima(const std::vector<double>& values) {
  const size_t n = values.size();
  const auto height = [&](size_t i) {
    return std::isnan(values[i % n]) ? std::numeric_limits<double>::infinity() : values[i % n];
  };
  std::vector<size_t> minima;
  for (size_t i = 0; i < n; ++i) {
    // Of a plateau, its first index; of a constant curve, index 0.
    if (!std::isfinite(height(i)) || (i > 0 && height(i) == height(i - 1))) continue;
    size_t end = i + 1;
    while (end < i + n && height(end) == height(i)) ++end;
    const bool is_constant = end == i + n;
    if (is_constant || (height(end) > height(i) && height(i) < height(i + n - 1))) {
      minima.push_back(i);
    }
  }
  std::stable_sort(minima.begin(), minima.end(),
                   [&](size_t one, size_t other) { return values[one] < values[other]; });
  return minima;
}

std::vector<UprightSolution> LocalOptima(const UprightObservation& observation,
                                         const YawObjective& objective, const YawSweep& sweep,
                                         size_t max_count) {
  const double step = std::numbers::pi / static_cast<double>(sweep.yaw.size());
  const auto yaw_of = [&](const UprightSolution& solution) {
    return Yaw(observation.plane_in_camera.normal, solution.landmark.frame_from_object.rotation);
  };
  std::vector<UprightSolution> optima;
  std::vector<size_t> minima = CircularMinima(sweep.Costs());
  minima.resize(std::min(minima.size(), std::max(max_count, kRefinedMinima)));
  for (const size_t i : minima) {
    const auto solution = RefineYaw(observation, objective, sweep.solutions[i]->landmark, step);
    if (!solution) continue;
    const bool known = std::any_of(optima.begin(), optima.end(), [&](const auto& other) {
      return std::abs(YawDifferenceModuloPi(yaw_of(*solution), yaw_of(other))) < kSameYaw;
    });
    if (!known) optima.push_back(*solution);
  }
  std::stable_sort(optima.begin(), optima.end(),
                   [](const auto& one, const auto& other) { return one.cost < other.cost; });
  optima.resize(std::min(optima.size(), max_count));
  return optima;
}

}  // namespace soslam
