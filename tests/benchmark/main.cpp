// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <opencv2/core/utility.hpp>

#include "soslam/system/process.h"

// Like benchmark_main, with the setting of stages for OpenCV's threads, and with the
// processor's name in the result.
int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::AddCustomContext("cpu", soslam::ThisMachine().cpu);
  benchmark::AddCustomContext("compiler", __VERSION__);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
