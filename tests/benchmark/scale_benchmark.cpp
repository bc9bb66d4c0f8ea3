// SPDX-License-Identifier: BSD-3-Clause
// How time and memory of the back end grow with the world: as many objects as frames, twenty
// observations of each.
#include <benchmark/benchmark.h>
#include <malloc.h>

#include <fstream>
#include <string>

#include "benchmark/drive.h"
#include "benchmark/inputs.h"

namespace soslam {
namespace {

// From now on the process's peak counts anew (Linux; elsewhere it is that of the whole run).
void ForgetPeakMemory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

double PeakMemoryMb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024.0;
  }
  return 0.0;
}

void World(benchmark::State& state) {
  const auto size = static_cast<int>(state.range(0));
  const Drive drive(size, size);
  const BackEndInput input{drive.sequence, drive.initial_landmarks, drive.priors};
  ForgetPeakMemory();
  MapEstimate map;
  for (auto _ : state) map = OptimiseMap(input, OptionsOfOursST());
  state.counters["peak_mb"] = PeakMemoryMb();
  state.counters["observations"] = static_cast<double>(drive.sequence.detections.size());
  state.counters["solver_iterations"] = map.solver.iterations;
  state.counters["converged"] = map.solver.converged;
}
BENCHMARK(World)
    ->Name("scale/back_end")
    ->ArgName("frames_and_objects")
    ->Arg(125)
    ->Arg(250)
    ->Arg(500)
    ->Arg(1000)
    ->Arg(4000)
    ->Iterations(1)
    ->Repetitions(3)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace soslam
