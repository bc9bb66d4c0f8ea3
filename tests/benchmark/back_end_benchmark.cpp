// SPDX-License-Identifier: BSD-3-Clause
// The back end of one object, from the landmark of its first observation.
#include <benchmark/benchmark.h>

#include "benchmark/back_end_input.h"
#include "benchmark/inputs.h"
#include "initialisation/initialise.h"
#include "mapping/initial_landmarks.h"
#include "support/scene.h"

namespace soslam {
namespace {

void Optimise(benchmark::State& state, const OneObject& object, const OptimiseOptions& options) {
  MapEstimate map;
  for (auto _ : state) map = OptimiseMap(object.input, options);
  state.counters["solver_iterations"] = map.solver.iterations;
  state.counters["iou"] = object.Iou(map);
}

// 12 boxes, their poses variable; the argument is how many observations' texture counts.
void TwelveBoxes(benchmark::State& state) {
  const OneObject object(TwelveViews(), 1, static_cast<size_t>(state.range(0)));
  Optimise(state, object, OptionsOfOursST());
}
BENCHMARK(TwelveBoxes)
    ->Name("back_end/12_boxes")
    ->ArgName("textures")
    ->Arg(0)
    ->Arg(1)
    ->Arg(12)
    ->Unit(benchmark::kMillisecond);

void WithCovariances(benchmark::State& state) {
  const OneObject object(TwelveViews(), 1, 0);
  OptimiseOptions options = OptionsOfOursST();
  options.covariances = true;
  Optimise(state, object, options);
}
BENCHMARK(WithCovariances)
    ->Name("back_end/12_boxes_with_covariances")
    ->Unit(benchmark::kMillisecond);

// 39 boxes from poses that stay as they are, as fr3_cabinet has.
void FixedPoses(benchmark::State& state) {
  static const Sequence sequence = SyntheticSequence(ArcScene(39), /*noise=*/true);
  const OneObject object(sequence, 1, 0);
  OptimiseOptions options = OptionsOfOursST();
  options.hold_poses = true;
  Optimise(state, object, options);
}
BENCHMARK(FixedPoses)->Name("back_end/39_boxes_fixed_poses")->Unit(benchmark::kMillisecond);

// What the pipeline does before: a start from the hypotheses of all observations.
void ChooseStart(benchmark::State& state) {
  const OneObject object(TwelveViews(), 1, 0);
  const auto estimates = InitialiseUpright(object.sequence, object.input.priors, UprightOptions(),
                                           /*threads=*/1);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        ChooseInitialUprightLandmarks(object.input, estimates, OptionsOfOursST(), 1));
  }
}
BENCHMARK(ChooseStart)->Name("back_end/choose_start")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace soslam
