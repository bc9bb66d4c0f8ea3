// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/fuzz_target.h"
#include "image/onnx_check.h"
#include "image/onnx_header.h"

namespace soslam {
namespace {

// Not OpenCV's reader, which is not for hostile input.
const FuzzTarget kNetworks("networks", [](const HostileInput& input) {
  const auto file = input.AsFile("network.onnx");
  const std::string bytes = FileBytes(file);
  IsAccepted(file, [&] {
    CheckOnnx(bytes, file.string());
    ReadOnnxHeader(bytes, file.string());
  });
});

}  // namespace
}  // namespace soslam
