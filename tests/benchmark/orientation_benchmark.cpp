// SPDX-License-Identifier: BSD-3-Clause
// The texture and the edges of one observation; edge maps are there already.
#include <benchmark/benchmark.h>

#include "benchmark/inputs.h"
#include "benchmark/texture_settings.h"
#include "geometry/angles.h"
#include "initialisation/initialise.h"
#include "orientation/refine_orientation.h"
#include "orientation/refine_symmetry.h"
#include "orientation/symmetry_samples.h"
#include "orientation/texture_asymmetry.h"
#include "orientation/yaw_profile.h"

namespace soslam {
namespace {

struct TexturedView {
  Sequence sequence = FirstObservations(OnlyObject(TwelveViews(), 1));
  const Detection& detection = sequence.detections.front();
  std::shared_ptr<const FrameEdges> edges = EdgesOfTwelveViews().front();
  std::vector<std::optional<ShapePrior>> priors = TruePriors(sequence);
  SymmetryImage image{edges->maps, detection.box};
  Landmark landmark_in_camera = *TrueLandmarkInCamera(sequence, detection);
};

// What an observation's texture is looked up in.
void MakeSymmetryImage(benchmark::State& state) {
  const TexturedView view;
  for (auto _ : state) {
    benchmark::DoNotOptimize(SymmetryImage(view.edges->maps, view.detection.box));
  }
}
BENCHMARK(MakeSymmetryImage)->Name("texture/symmetry_image");

// The asymmetry of one landmark's texture, at 17 places of the mirror plane (InitST, OursST).
void FindMirror(benchmark::State& state) {
  const TexturedView view;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        TextureAsymmetry(view.image, view.sequence.camera, TextureOfST(), SymmetryOfST())
            .Find(view.landmark_in_camera));
  }
  state.counters["samples"] = static_cast<double>(
      SamplePixels(view.image, view.sequence.camera, view.landmark_in_camera, SymmetryOfST())
          .size());
}
BENCHMARK(FindMirror)->Name("texture/asymmetry");

// The paper's cost over yaw (fig. 7), half a turn in steps of 2 degrees.
void Profile(benchmark::State& state, Descriptor descriptor) {
  const TexturedView view;
  const SymmetryOptions options;
  const auto samples =
      SamplePixels(view.image, view.sequence.camera, view.landmark_in_camera, options);
  for (auto _ : state) {
    benchmark::DoNotOptimize(ComputeYawProfile(view.image, view.sequence.camera,
                                               view.landmark_in_camera, samples, {descriptor},
                                               options, 2.0 * kRadPerDeg));
  }
  state.counters["samples"] = static_cast<double>(samples.size());
}
BENCHMARK_CAPTURE(Profile, improved_dt, Descriptor::kImprovedDt)
    ->Name("texture/yaw_profile/improved_dt");
BENCHMARK_CAPTURE(Profile, linearised, Descriptor::kLinearisedDt)
    ->Name("texture/yaw_profile/improved_dt_linearised");

// The paper's refinement of an initial landmark, with the curves of all descriptors (InitPT).
void TurnToSymmetry(benchmark::State& state) {
  const TexturedView view;
  const auto initial = InitialiseSingleFrame(view.sequence, {view.priors.front()->ratio},
                                             InitialiseOptions(), /*threads=*/1);
  for (auto _ : state) {
    benchmark::DoNotOptimize(RefineObservation(view.sequence, initial.observations.front(),
                                               view.edges->maps, view.priors.front()->ratio,
                                               RefineOptions()));
  }
}
BENCHMARK(TurnToSymmetry)->Name("texture/InitPT");

// The orientation profile with texture (InitST), and with edges as well (InitSTE).
void RefineByProfile(benchmark::State& state, bool edge_alignment) {
  const TexturedView view;
  ProfileOptions options;
  options.edge_alignment = edge_alignment;
  options.texture = TextureOfST();
  for (auto _ : state) {
    benchmark::DoNotOptimize(RefineOrientation(view.sequence, 0, view.edges, view.priors.front(),
                                               options, SymmetryOfST()));
  }
}
BENCHMARK_CAPTURE(RefineByProfile, texture, false)->Name("texture/InitST");
BENCHMARK_CAPTURE(RefineByProfile, texture_and_edges, true)->Name("texture/InitSTE");

}  // namespace
}  // namespace soslam
