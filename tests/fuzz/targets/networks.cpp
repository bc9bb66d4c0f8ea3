// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/fuzz_target.h"
#include "image/onnx_check.h"

namespace soslam {
namespace {

// Not OpenCV's reader, which is not for hostile input.
const FuzzTarget kNetworks("networks", [](const HostileInput& input) {
  const auto file = input.AsFile("network.onnx");
  IsAccepted(file, [&] { CheckOnnx(FileBytes(file), file.string()); });
});

}  // namespace
}  // namespace soslam
