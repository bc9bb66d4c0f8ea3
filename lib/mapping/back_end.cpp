// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end.h"

#include "mapping/back_end_problem.h"
#include "mapping/covariance.h"

namespace soslam {
namespace {

// Which edges are visible settles with the landmarks.
constexpr int kEdgeRounds = 3;

void AddCovariances(BackEndProblem* problem, MapEstimate* map) {
  std::vector<const double*> blocks;
  std::vector<ObjectEstimate*> objects;
  for (ObjectEstimate& object : map->objects) {
    if (!object.landmark_in_world) continue;
    blocks.push_back(problem->LandmarkData(static_cast<size_t>(object.object_index)));
    objects.push_back(&object);
  }
  const auto covariances = LandmarkCovariances(blocks, &problem->problem());
  if (!covariances) {
    map->solver.gated["covariance_of_undetermined_problem"] = static_cast<int>(objects.size());
    return;
  }
  for (size_t i = 0; i < objects.size(); ++i) objects[i]->covariance = (*covariances)[i];
}

}  // namespace

MapEstimate OptimiseMap(const BackEndInput& input, const OptimiseOptions& options) {
  BackEndProblem problem(input, options);
  MapEstimate map;
  problem.Solve();
  if (!input.symmetry_images.empty()) {
    problem.AddSymmetry();
    problem.Solve();
  }
  for (int round = 0; round < kEdgeRounds && !input.edge_images.empty(); ++round) {
    problem.RenewEdges();
    problem.Solve();
  }
  map.solver = problem.summary();
  for (const PoseBlock& pose : problem.poses()) {
    map.world_from_camera.push_back(UnpackPose(pose.data()));
  }
  const auto detections = DetectionsByObject(input.sequence);
  for (size_t i = 0; i < input.starts.size(); ++i) {
    ObjectEstimate object;
    object.object_index = static_cast<int>(i);
    object.observations = static_cast<int>(detections[i].size());
    if (input.starts[i]) {
      object.landmark_in_world = problem.LandmarkInWorld(i);
    } else {
      object.failure = input.sequence.objects[i].is_static ? "no_start" : "moving";
    }
    map.objects.push_back(object);
  }
  if (options.covariances) AddCovariances(&problem, &map);
  return map;
}

}  // namespace soslam
