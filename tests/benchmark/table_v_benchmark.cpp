// SPDX-License-Identifier: BSD-3-Clause
// The columns of the paper's Table V: what this project does, and the paper's method as it
// describes it, on the same boxes and images. Times are those of six objects.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <map>
#include <memory>
#include <numbers>

#include "benchmark/inputs.h"
#include "benchmark/paper_baseline.h"
#include "soslam/initialisation/initialise.h"
#include "soslam/orientation/refine_by_profile.h"

namespace soslam {
namespace {

using Landmarks = std::vector<Landmark>;  // in the world, by object

// A baseline that is worse by more than this has not converged to what it should.
constexpr double kComparableIou = 0.1;

// ---- This project.

Landmarks SingleFrame() {
  static const Sequence sequence = FirstObservations(TwelveViews());
  static const auto priors = TruePriors(sequence);
  const auto estimates = InitialiseUpright(sequence, priors, UprightOptions(), /*threads=*/1);
  Landmarks landmarks;
  for (const ObservationEstimate& estimate : estimates.observations) {
    landmarks.push_back(FacingCamera(sequence, estimate));
  }
  return landmarks;
}

Landmarks SingleFrameTexture() {
  static const Sequence sequence = FirstObservations(TwelveViews());
  static const auto priors = TruePriors(sequence);
  ProfileOptions options;
  options.edge_alignment = false;
  options.texture = TextureOfST();
  Landmarks landmarks;
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Detection& detection = sequence.detections[i];
    const auto refined =
        RefineByProfile(sequence, static_cast<int>(i), EdgesOfTwelveViews()[detection.frame_index],
                        priors[detection.object_index], options, SymmetryOfST());
    landmarks.push_back(Transform(sequence.FrameOf(detection).world_from_camera,
                                  refined.estimate.hypotheses.front().landmark_in_camera));
  }
  return landmarks;
}

template <size_t kTextures>
Landmarks AllFrames() {
  static const auto objects = [] {
    std::vector<std::unique_ptr<OneObject>> result;
    for (size_t i = 0; i < TwelveViews().objects.size(); ++i) {
      result.push_back(std::make_unique<OneObject>(TwelveViews(), i, kTextures));
    }
    return result;
  }();
  Landmarks landmarks;
  for (const auto& object : objects) {
    landmarks.push_back(
        *OptimiseMap(object->input, OptionsOfOursST()).objects.front().landmark_in_world);
  }
  return landmarks;
}

// ---- The paper's method.

// All boxes of an object, with the edges of the first `textures` of them.
paper::Observations PaperObservations(size_t object_index, size_t boxes, size_t textures) {
  const Sequence sequence = OnlyObject(TwelveViews(), object_index);
  const Landmark& truth = sequence.objects.front().ground_truth->landmark_in_world;
  paper::Observations observations{sequence.camera,
                                   {},
                                   sequence.planes.front().plane_in_world,
                                   truth.half_axes.head<2>() / truth.half_axes.z()};
  for (size_t i = 0; i < boxes; ++i) {
    const Detection& detection = sequence.detections[i];
    const auto frame = static_cast<size_t>(detection.frame_index);
    observations.views.push_back({sequence.FrameOf(detection).world_from_camera, detection.box,
                                  i < textures ? &EdgesOfTwelveViews()[frame]->maps : nullptr});
  }
  return observations;
}

std::vector<paper::Observations> PaperObservations(size_t boxes, size_t textures) {
  std::vector<paper::Observations> all;
  for (size_t i = 0; i < TwelveViews().objects.size(); ++i) {
    all.push_back(PaperObservations(i, boxes, textures));
  }
  return all;
}

// From the world's axis, near which these objects' fronts are.
Landmark PaperInitialisation(const paper::Observations& first) {
  return SolveSingleFrame(first, *Start(first, 0.0)).landmark_in_world;
}

Landmarks PaperSingleFrame() {
  static const auto observations = PaperObservations(1, 0);
  Landmarks landmarks;
  for (const auto& first : observations) landmarks.push_back(PaperInitialisation(first));
  return landmarks;
}

// From yaws all around, as the sweep looks: of the solutions of lowest cost the one found first.
Landmarks PaperSingleFrameAllYaws() {
  constexpr int kYaws = 12;
  constexpr double kTie = 1e-9;
  static const auto observations = PaperObservations(1, 0);
  Landmarks landmarks;
  for (const auto& first : observations) {
    std::optional<paper::Solution> best;
    for (int i = 0; i < kYaws; ++i) {
      const auto solution = SolveSingleFrame(first, *Start(first, i * std::numbers::pi / kYaws));
      if (!best || solution.cost < best->cost - kTie) best = solution;
    }
    landmarks.push_back(best->landmark_in_world);
  }
  return landmarks;
}

Landmarks PaperSingleFrameTexture() {
  static const auto without = PaperObservations(1, 0);
  static const auto with = PaperObservations(1, 1);
  Landmarks landmarks;
  for (size_t i = 0; i < with.size(); ++i) {
    landmarks.push_back(
        SolveSingleFrame(with[i], PaperInitialisation(without[i])).landmark_in_world);
  }
  return landmarks;
}

template <size_t kTextures>
Landmarks PaperAllFrames() {
  static const auto observations = PaperObservations(12, kTextures);
  static const Landmarks initial_landmarks = PaperSingleFrame();
  Landmarks landmarks;
  for (size_t i = 0; i < initial_landmarks.size(); ++i) {
    landmarks.push_back(SolveAllFrames(observations[i], initial_landmarks[i]).landmark_in_world);
  }
  return landmarks;
}

// ---- Comparison.

// Mean IoU of a method's landmarks, computed once.
double IouOf(Landmarks (*method)()) {
  static std::map<Landmarks (*)(), double> known;
  const auto found = known.find(method);
  if (found != known.end()) return found->second;
  return known[method] = MeanIou(TwelveViews(), method());
}

void Measure(benchmark::State& state, Landmarks (*method)(), Landmarks (*comparable)()) {
  const double iou = IouOf(method);
  if (comparable != nullptr && iou < IouOf(comparable) - kComparableIou) {
    state.SkipWithError(fmt::format("IoU is {:.3f} only", iou).c_str());
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(method());
  state.counters["iou"] = iou;
  state.counters["seconds_per_object"] = benchmark::Counter(
      static_cast<double>(TwelveViews().objects.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

#define BENCHMARK_METHOD(method, name, comparable) \
  BENCHMARK_CAPTURE(Measure, method, method, comparable)->Name(name)->Unit(benchmark::kMillisecond)

BENCHMARK_METHOD(SingleFrame, "table_v/single_frame/ours", nullptr);
BENCHMARK_METHOD(PaperSingleFrame, "table_v/single_frame/paper_baseline", SingleFrame);
BENCHMARK_METHOD(PaperSingleFrameAllYaws, "table_v/single_frame/paper_baseline_12_yaws",
                 SingleFrame);
BENCHMARK_METHOD(SingleFrameTexture, "table_v/single_frame_texture/ours", nullptr);
BENCHMARK_METHOD(PaperSingleFrameTexture, "table_v/single_frame_texture/paper_baseline",
                 SingleFrameTexture);
BENCHMARK_METHOD(AllFrames<0>, "table_v/12_frames/ours", nullptr);
BENCHMARK_METHOD(PaperAllFrames<0>, "table_v/12_frames/paper_baseline", AllFrames<0>);
BENCHMARK_METHOD(AllFrames<1>, "table_v/12_frames_texture/ours", nullptr);
BENCHMARK_METHOD(PaperAllFrames<1>, "table_v/12_frames_texture/paper_baseline", AllFrames<1>);
BENCHMARK_METHOD(AllFrames<12>, "table_v/12_frames_12_textures/ours", nullptr);
BENCHMARK_METHOD(PaperAllFrames<12>, "table_v/12_frames_12_textures/paper_baseline", AllFrames<12>);

}  // namespace
}  // namespace soslam
