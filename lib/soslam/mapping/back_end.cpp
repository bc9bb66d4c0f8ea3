// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/back_end.h"

#include <algorithm>

#include "soslam/base/error.h"
#include "soslam/mapping/back_end_problem.h"
#include "soslam/mapping/check_input.h"
#include "soslam/mapping/covariance.h"
#include "soslam/mapping/input_alternatives.h"

namespace soslam {
namespace {

// Image residuals are renewed until no landmark changes by more than the tolerance (m per m of
// size, rad): which texture and edges are visible, and where the mirror planes are, depends on the
// landmarks.
constexpr int kMaxImageRounds = 50;
constexpr double kConvergenceTolerance = 1e-3;
// A round need not converge, as the next one changes its residuals.
constexpr int kIterationsPerRound = 10;

// Returns whether the landmarks converged: they are at the minimum of the residuals made for them.
bool SolveWithImages(BackEndProblem* problem) {
  const BackEndVariables& variables = problem->variables();
  for (int round = 0; round < kMaxImageRounds; ++round) {
    if (problem->IterationsLeft() <= 0) return false;
    const std::vector<std::optional<Landmark>> before = variables.LandmarkValues();
    const auto have_converged = [&] {
      double change = 0.0;
      for (size_t i = 0; i < before.size(); ++i) {
        if (!before[i]) continue;
        const Landmark to = variables.LandmarkValue(i);
        const double size = MeanHalfAxis(*before[i]);
        const double turn =
            to.frame_from_object.rotation.angularDistance(before[i]->frame_from_object.rotation);
        change =
            std::max(change, std::max({(to.Centre() - before[i]->Centre()).norm() / size,
                                       (to.half_axes - before[i]->half_axes).norm() / size, turn}));
      }
      return change < kConvergenceTolerance;
    };
    problem->RenewImageResiduals();
    problem->Solve(kIterationsPerRound);
    if (!have_converged()) continue;
    problem->Solve();
    if (have_converged()) return true;
  }
  problem->Solve();
  return false;
}

void AddCovariances(const Sequence& sequence, const MarginalCovariances& covariances,
                    double dispersion, BackEndProblem* problem, MapEstimate* map) {
  BackEndVariables& variables = problem->variables();
  int without = 0;
  for (ObjectEstimate& object : map->objects) {
    if (!object.landmark_in_world) continue;
    const double* landmark = variables.Landmark(object.object_index);
    if (covariances.Has(landmark)) {
      object.covariance = dispersion * covariances.OfLandmark(landmark);
    } else {
      ++without;
    }
  }
  if (without > 0) map->solver.gated["covariance_of_undetermined_problem"] = without;
  for (size_t i = 0; i < sequence.planes.size() && covariances.AreDetermined(); ++i) {
    const bool has_objects = problem->problem().HasParameterBlock(variables.Offset(i));
    if (!sequence.planes[i].attitude_information || !has_objects) continue;
    Eigen::Vector4d sides = Eigen::Vector4d::Ones();
    sides.head<3>() *= variables.NormalSide(i);
    map->plane_covariances[static_cast<int>(i)] =
        dispersion * sides.asDiagonal() *
        covariances.OfPlane(variables.Normal(i), variables.Offset(i)) * sides.asDiagonal();
  }
}

// OptimiseMap of input that is checked.
MapEstimate OptimiseChecked(const BackEndInput& input, const OptimiseOptions& options,
                            int threads) {
  BackEndProblem problem(input, options, threads);
  MapEstimate map;
  problem.Solve();
  bool has_converged = true;
  if (options.detection_model == DetectionModel::kTangency) {
    if (options.check_inputs && problem.summary().converged) {
      map.input_alternatives = FindInputAlternatives(input, options, problem.variables());
    }
    if (!input.images.empty() || !input.points.empty()) {
      has_converged = SolveWithImages(&problem);
    }
  } else if (!input.images.empty()) {
    problem.RenewImageResiduals();  // the paper's pairs stay those of this map
    problem.Solve();
  }
  map.solver = problem.summary();
  map.solver.converged = map.solver.converged && has_converged;
  const BackEndVariables& variables = problem.variables();
  map.world_from_camera.reserve(input.sequence.frames.size());
  for (size_t i = 0; i < input.sequence.frames.size(); ++i) {
    map.world_from_camera.push_back(variables.PoseValue(i));
  }
  for (size_t i = 0; i < input.sequence.planes.size(); ++i) {
    map.planes_in_world.push_back(variables.PlaneValue(i));
  }
  const auto detections = DetectionsByObject(input.sequence);
  const std::vector<std::optional<Landmark>> landmarks = variables.LandmarkValues();
  for (size_t i = 0; i < landmarks.size(); ++i) {
    ObjectEstimate object;
    object.object_index = static_cast<int>(i);
    object.observations = static_cast<int>(detections[i].size());
    if (!landmarks[i]) {
      object.failure = input.sequence.objects[i].is_static ? "no_start" : kMovingObject;
    } else if (HasExtent(*landmarks[i])) {
      object.landmark_in_world = landmarks[i];
      object.points = problem.ComputePosteriors(i);
    } else {
      object.failure = "collapsed";  // as boxes alone may be explained best
    }
    map.objects.push_back(object);
  }
  if (options.covariances) {
    problem.PrepareCovariances();
    const MarginalCovariances covariances(&problem.problem());
    // The paper's variances are no noise of boxes.
    const bool is_noise = options.detection_model == DetectionModel::kTangency;
    const double dispersion = is_noise ? map.solver.Dispersion() : 1.0;
    AddCovariances(input.sequence, covariances, dispersion, &problem, &map);
  }
  return map;
}

}  // namespace

MapEstimate OptimiseMap(const BackEndInput& input, const OptimiseOptions& options, int threads) {
  CheckBackEndInput(input, options);
  CheckInitialLandmarks(input);
  return OptimiseChecked(input, options, threads);
}

std::optional<OptimisedObject> OptimiseObject(const BackEndInput& input, size_t object_index,
                                              const Landmark& start,
                                              const OptimiseOptions& options) {
  OptimiseOptions alone = options;
  alone.hold_poses = true;
  alone.refine_planes = false;
  alone.covariances = false;
  alone.check_inputs = false;
  BackEndInput of_object = input;
  of_object.images_weighed_at = input.initial_landmarks;
  std::ranges::fill(of_object.initial_landmarks, std::nullopt);
  of_object.initial_landmarks[object_index] = start;
  try {
    const MapEstimate map = OptimiseChecked(of_object, alone, /*threads=*/1);
    const auto& landmark = map.objects[object_index].landmark_in_world;
    if (!landmark) return std::nullopt;
    return OptimisedObject{*landmark, map.solver.final_cost + map.solver.constant_cost,
                           map.solver.initial_cost};
  } catch (const NumericalError&) {
    return std::nullopt;
  }
}

}  // namespace soslam
