// SPDX-License-Identifier: BSD-3-Clause
// One landmark from one box, and what of it costs how much; one landmark from many boxes.
#include <benchmark/benchmark.h>

#include <vector>

#include "benchmark/inputs.h"
#include "geometry/angles.h"
#include "initialisation/closed_form.h"
#include "initialisation/initialise.h"
#include "initialisation/multi_view.h"
#include "initialisation/yaw_sweep.h"

namespace soslam {
namespace {

constexpr double kYawStep = 3.0 * kRadPerDeg;

struct OneBox {
  Sequence sequence = FirstObservations(OnlyObject(TwelveViews(), 1));
  std::vector<std::optional<ShapePrior>> priors = TruePriors(sequence);
  UprightObservation observation = MakeUprightObservation(sequence, sequence.detections.front(),
                                                          *priors.front(), UprightOptions());
};

// The closed form at one yaw, as in the sweep.
void SolveAtOneYaw(benchmark::State& state) {
  const ClosedForm closed_form(OneBox().observation);
  double yaw = 0.3;
  for (auto _ : state) {
    benchmark::DoNotOptimize(yaw);
    benchmark::DoNotOptimize(closed_form.At(yaw));
  }
}
BENCHMARK(SolveAtOneYaw)->Name("single_frame/closed_form");

// Levenberg-Marquardt from there with the yaw fixed, as in the sweep, or free, as at its optima.
void Fit(benchmark::State& state, bool yaw_is_free) {
  const OneBox box;
  const auto solution = ClosedForm(box.observation).At(/*yaw=*/0.3);
  const Landmark start =
      UprightGround(box.observation.plane_in_camera)
          .LandmarkAt(solution->parameters, box.observation.prior.shape_exponent);
  const LandmarkCosts costs = ObservationTerms(box.observation, start);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        FitUpright(box.observation.plane_in_camera, start, costs, yaw_is_free));
  }
}
BENCHMARK_CAPTURE(Fit, at_yaw, false)->Name("single_frame/fit_at_yaw");
BENCHMARK_CAPTURE(Fit, polish, true)->Name("single_frame/polish");

// Half a turn in steps of 3 degrees: both of the above, 60 times.
void Sweep(benchmark::State& state) {
  const OneBox box;
  for (auto _ : state) {
    benchmark::DoNotOptimize(SweepYaw(box.observation, {}, kYawStep));
  }
}
BENCHMARK(Sweep)->Name("single_frame/sweep");

// What lib/initialisation does for one observation: the sweep and its local optima, refined.
void Whole(benchmark::State& state) {
  const OneBox box;
  size_t hypotheses = 0;
  for (auto _ : state) {
    const auto estimates =
        InitialiseUpright(box.sequence, box.priors, UprightOptions(), /*threads=*/1);
    hypotheses = estimates.observations.front().hypotheses.size();
  }
  state.counters["hypotheses"] = static_cast<double>(hypotheses);
}
BENCHMARK(Whole)->Name("single_frame/whole");

// The paper's method as InitP has it: eq. (12) with analytic derivatives, from twelve yaws.
void PaperWithAnalyticDerivatives(benchmark::State& state) {
  const OneBox box;
  for (auto _ : state) {
    benchmark::DoNotOptimize(InitialiseSingleFrame(box.sequence, {box.priors.front()->ratio},
                                                   InitialiseOptions(), /*threads=*/1));
  }
}
BENCHMARK(PaperWithAnalyticDerivatives)->Name("single_frame/InitP");

// From all twelve boxes of the object at once.
void MultiView(benchmark::State& state) {
  const Sequence sequence = OnlyObject(TwelveViews(), 1);
  const auto priors = TruePriors(sequence);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        InitialiseMultiView(sequence, priors, InitialiseOptions(), /*threads=*/1));
  }
}
BENCHMARK(MultiView)->Name("multi_view/12_boxes");

}  // namespace
}  // namespace soslam
