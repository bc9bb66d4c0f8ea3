// SPDX-License-Identifier: BSD-3-Clause
// All variants of data/room_a from its images, as `make run` makes them: on the clock, and the CPU
// seconds of each stage as its processes took them.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "soslam/artefact/json_file.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

// Whether it succeeded.
bool RunAllVariants(const std::filesystem::path& results) {
  const std::string command = fmt::format(
      "env --unset=MAKEFLAGS --unset=MAKELEVEL make --silent -C '{}' run DATASET=room_a "
      "DATA_ROOT=data VARIANT=all BUILD='{}' RESULTS='{}' > '{}'/log 2>&1",
      SOSLAM_SOURCE_DIR, SOSLAM_BUILD_DIR, results.string(), results.string());
  return std::system(command.c_str()) == 0;
}

std::map<std::string, double> CpuSecondsOfStages(const std::filesystem::path& results) {
  std::map<std::string, double> seconds;
  for (const auto& entry : std::filesystem::directory_iterator(results / "room_a" / "shared")) {
    if (!std::filesystem::exists(entry.path() / "run.json")) continue;
    const nlohmann::json run = ParseJsonFile(entry.path() / "run.json");
    seconds[run.at("stage")] += run.at("timing").at("cpu_s").get<double>();
  }
  return seconds;
}

void AllVariants(benchmark::State& state) {
  for (auto _ : state) {
    const TemporaryFolder results;
    if (!RunAllVariants(results.path())) {
      state.SkipWithError("make run failed");
      return;
    }
    state.PauseTiming();
    for (const auto& [stage, seconds] : CpuSecondsOfStages(results.path())) {
      state.counters[stage + "_cpu_s"] = seconds;
    }
    state.ResumeTiming();
  }
}
BENCHMARK(AllVariants)
    ->Name("pipeline/room_a_all_variants")
    ->Iterations(1)
    ->Repetitions(3)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace soslam
