// SPDX-License-Identifier: BSD-3-Clause
// Two SLAM problems with known truth (tests/support/real_data.h; not where they are missing): poses
// from dead reckoning, ellipsoids of any ratio, one thread.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "soslam/dataset/dataset_content.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/mapping/back_end.h"
#include "support/real_data.h"

namespace soslam {
namespace {

// With the odometry's noise of the problem; its boxes have 2 px.
OptimiseOptions OptionsOfProblem() {
  OptimiseOptions options;
  options.detection_model = DetectionModel::kTangency;
  options.shape = ShapeSource::kEllipsoid;
  options.ratio = false;
  options.odometry_rotation_sigma_deg = 0.5;
  options.odometry_translation_sigma_m = 0.01;
  options.upright.view_correlation_deg = 0.0;
  options.upright.axes_weight = 0.0;
  options.upright.huber_delta = 1e6;  // no outliers, but far initial_landmarks
  options.covariances = false;
  return options;
}

// Starts are the true ellipsoids with errors: 5 cm, a fifth of the half axes, 0.2 rad of yaw.
BackEndInput InputOf(const Sequence& sequence) {
  std::mt19937 random(7);
  std::normal_distribution<double> gaussian;
  const auto error = [&](double sigma) { return sigma * gaussian(random); };
  BackEndInput input{sequence, {}, {}};
  input.priors.resize(sequence.objects.size());
  for (const Object& object : sequence.objects) {
    Landmark start = RotatedAboutZ(object.ground_truth->landmark_in_world, error(0.2));
    for (double& coordinate : start.frame_from_object.translation) coordinate += error(0.05);
    for (double& half_axis : start.half_axes) half_axis *= std::exp(error(0.2));
    input.initial_landmarks.push_back(start);
  }
  return input;
}

// The root mean square distance (m) from the true camera centres; not aligned, as both begin at the
// true first pose.
double TrajectoryError(const Sequence& sequence, const std::vector<Rigid3d>& world_from_camera) {
  double squares = 0.0;
  for (size_t i = 0; i < world_from_camera.size(); ++i) {
    const Rigid3d& truth = *sequence.frames[i].true_world_from_camera;
    squares += (world_from_camera[i].translation - truth.translation).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(world_from_camera.size()));
}

// Median error of the centres, m.
double MedianError(const Sequence& sequence, const MapEstimate& map) {
  std::vector<double> errors;
  for (const ObjectEstimate& object : map.objects) {
    if (!object.landmark_in_world) continue;
    const Object& truth = sequence.objects[object.object_index];
    errors.push_back(
        (object.landmark_in_world->Centre() - truth.ground_truth->landmark_in_world.Centre())
            .norm());
  }
  return MedianOf(errors).value();
}

void Problem(benchmark::State& state, const char* name) {
  ImportOptions import;
  import.format = DatasetFormat::kSlamSynthetic;
  import.kitti.sequences = name;
  import.border_px = 0.0;
  const Sequence sequence = ImportDataset(RealDataset("slam_synthetic"), import);
  const BackEndInput input = InputOf(sequence);
  MapEstimate map;
  for (auto _ : state) map = OptimiseMap(input, OptionsOfProblem());
  state.counters["solver_iterations"] = map.solver.iterations;
  state.counters["final_cost"] = map.solver.final_cost;
  state.counters["trajectory_error_m"] = TrajectoryError(sequence, map.world_from_camera);
  state.counters["dead_reckoning_error_m"] = TrajectoryError(sequence, PosesOf(sequence));
  state.counters["centre_error_m"] = MedianError(sequence, map);
}
[[maybe_unused]] const bool kAreRegistered = [] {
  if (!std::filesystem::exists(RealDataset("slam_synthetic"))) return false;
  for (const char* name : {"K10N100", "K40N200"}) {
    benchmark::RegisterBenchmark(("slam_synthetic/" + std::string(name)).c_str(), Problem, name)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
}  // namespace soslam
