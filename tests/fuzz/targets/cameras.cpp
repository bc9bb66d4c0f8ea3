// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/calibration_file.h"
#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

const FuzzTarget kCameras("cameras", [](const HostileInput& input) {
  for (const char* name : {"camera.json", "camera.yaml", "camera.xml", "cameras.txt"}) {
    const auto file = input.AsFile(name);
    IsAccepted(file, [&] { ReadCameraFile(file); });
  }
});

}  // namespace
}  // namespace soslam
