// SPDX-License-Identifier: BSD-3-Clause
// Which boxes of data/room_a are of the same object.
#include <benchmark/benchmark.h>

#include "association/association.h"
#include "association/link_frames.h"
#include "benchmark/inputs.h"

namespace soslam {
namespace {

void CountPerFrame(benchmark::State& state) {
  state.counters["frames"] = static_cast<double>(RoomA().frames.size());
  state.counters["detections"] = static_cast<double>(RoomA().detections.size());
  state.counters["seconds_per_frame"] = benchmark::Counter(
      static_cast<double>(RoomA().frames.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// Frame by frame, tracks fitted anew with each box.
void Link(benchmark::State& state) {
  const AssociateOptions options;
  const AssociationModel model(RoomA(), TableOfPriors(), options);
  for (auto _ : state) benchmark::DoNotOptimize(LinkFrames(model, /*threads=*/1));
  CountPerFrame(state);
}
BENCHMARK(Link)->Name("association/link_frames")->Unit(benchmark::kMillisecond);

// And tracks merged, and false ones dropped.
void WholeSequence(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        Associate(RoomA(), TableOfPriors(), AssociateOptions(), /*threads=*/1));
  }
  CountPerFrame(state);
}
BENCHMARK(WholeSequence)->Name("association/sequence")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace soslam
