// SPDX-License-Identifier: BSD-3-Clause
#include "detector/yolo_detector.h"
#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

const FuzzTarget kNetwork("network", [](const HostileInput& input) {
  const auto file = input.AsFile("network.onnx");
  IsAccepted(file, [&] { YoloDetector(file, 2, {}); });
});

}  // namespace
}  // namespace soslam
