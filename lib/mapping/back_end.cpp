// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end.h"

#include <algorithm>
#include <cmath>

#include "mapping/back_end_problem.h"
#include "mapping/covariance.h"

namespace soslam {
namespace {

// What of texture and edges is visible, and where the mirror planes are, settles with the
// landmarks: renewed until none changes by more than this (m per m of size, rad).
constexpr int kMaxImageRounds = 25;
// A round need not end at the minimum of what is renewed in the next one.
constexpr int kIterationsPerRound = 10;
constexpr double kSettled = 1e-3;

double Change(const Landmark& from, const Landmark& to) {
  const double size = std::cbrt(from.half_axes.prod());
  return std::max({(to.Centre() - from.Centre()).norm() / size,
                   (to.half_axes - from.half_axes).norm() / size,
                   to.frame_from_object.rotation.angularDistance(from.frame_from_object.rotation)});
}

// In the world, where the variables are; none for objects without a start.
std::vector<std::optional<Landmark>> LandmarksOf(const BackEndProblem& problem, size_t objects) {
  std::vector<std::optional<Landmark>> landmarks;
  for (size_t i = 0; i < objects; ++i) {
    landmarks.push_back(problem.variables().LandmarkValue(i));
  }
  return landmarks;
}

double LargestChange(const std::vector<std::optional<Landmark>>& from,
                     const std::vector<std::optional<Landmark>>& to) {
  double change = 0.0;
  for (size_t i = 0; i < from.size(); ++i) {
    if (from[i]) change = std::max(change, Change(*from[i], *to[i]));
  }
  return change;
}

// Whether they settled: the minimum is where the image terms were made.
bool SettleWithImages(size_t objects, BackEndProblem* problem) {
  for (int round = 0; round < kMaxImageRounds; ++round) {
    const std::vector<std::optional<Landmark>> before = LandmarksOf(*problem, objects);
    problem->RenewImageTerms();
    problem->Solve(kIterationsPerRound);
    if (LargestChange(before, LandmarksOf(*problem, objects)) >= kSettled) continue;
    problem->Solve();
    if (LargestChange(before, LandmarksOf(*problem, objects)) < kSettled) return true;
  }
  problem->Solve();
  return false;
}

void AddObjects(const BackEndInput& input, const BackEndProblem& problem, MapEstimate* map) {
  const auto detections = DetectionsByObject(input.sequence);
  const std::vector<std::optional<Landmark>> landmarks = LandmarksOf(problem, input.starts.size());
  for (size_t i = 0; i < landmarks.size(); ++i) {
    ObjectEstimate object;
    object.object_index = static_cast<int>(i);
    object.observations = static_cast<int>(detections[i].size());
    if (!landmarks[i]) {
      object.failure = input.sequence.objects[i].is_static ? "no_start" : kMovingObject;
    } else if (HasExtent(*landmarks[i])) {
      object.landmark_in_world = landmarks[i];
    } else {
      object.failure = "collapsed";  // as boxes alone may be explained best
    }
    map->objects.push_back(object);
  }
}

void AddLandmarkCovariances(const MarginalCovariances& covariances, MapEstimate* map) {
  int without = 0;
  for (ObjectEstimate& object : map->objects) {
    if (!object.landmark_in_world) continue;
    const auto index = static_cast<size_t>(object.object_index);
    if (!covariances.HasLandmark(index)) {
      ++without;
      continue;
    }
    object.covariance = covariances.OfLandmark(index);
  }
  if (without > 0) map->solver.gated["covariance_of_undetermined_problem"] = without;
}

bool DependOn(int variable, const Terms& terms) {
  return std::ranges::any_of(terms, [variable](const Term* term) {
    return std::ranges::count(term->variables(), variable) > 0;
  });
}

void AddPlaneCovariances(const Sequence& sequence, const MarginalCovariances& covariances,
                         const BackEndProblem& problem, MapEstimate* map) {
  if (!covariances.AreDetermined()) return;
  const BackEndVariables& variables = problem.variables();
  for (size_t i = 0; i < sequence.planes.size(); ++i) {
    const bool holds_something = DependOn(variables.Offset(i), problem.AllTerms());
    if (!sequence.planes[i].attitude_information || !holds_something) continue;
    Eigen::Vector4d sides = Eigen::Vector4d::Ones();
    sides.head<3>() *= variables.NormalSide(i);
    map->plane_covariances[static_cast<int>(i)] =
        sides.asDiagonal() * covariances.OfPlane(i) * sides.asDiagonal();
  }
}

}  // namespace

MapEstimate OptimiseMap(const BackEndInput& input, const OptimiseOptions& options, int threads) {
  BackEndProblem problem(input, options, threads);
  MapEstimate map;
  problem.Solve(options.max_iterations);
  bool settled = true;
  if (options.detection_model == DetectionModel::kTangency) {
    if (!input.symmetry_images.empty() || !input.edge_images.empty()) {
      settled = SettleWithImages(input.starts.size(), &problem);
    }
  } else if (!input.symmetry_images.empty()) {
    problem.RenewImageTerms();  // the paper's pairs are those of the start
    problem.Solve();
  }
  map.solver = problem.summary();
  map.solver.converged = map.solver.converged && settled;
  const BackEndVariables& variables = problem.variables();
  map.world_from_camera.reserve(input.sequence.frames.size());
  for (size_t i = 0; i < input.sequence.frames.size(); ++i) {
    map.world_from_camera.push_back(variables.PoseValue(i));
  }
  for (size_t i = 0; i < input.sequence.planes.size(); ++i) {
    map.planes_in_world.push_back(variables.PlaneValue(i));
  }
  AddObjects(input, problem, &map);
  if (options.covariances) {
    const MarginalCovariances covariances(problem.variables(), problem.AllTerms());
    AddLandmarkCovariances(covariances, &map);
    AddPlaneCovariances(input.sequence, covariances, problem, &map);
  }
  return map;
}

}  // namespace soslam
