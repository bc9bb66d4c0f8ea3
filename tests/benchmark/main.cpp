// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <opencv2/core/utility.hpp>

#include "base/machine.h"

// As benchmark_main, with memory and OpenCV's threads as stages have them, and with the processor's
// name in the result.
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
