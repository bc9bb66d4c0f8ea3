// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/labelled_box.h"
#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

const FuzzTarget kBoxJson("box_json", [](const HostileInput& input) {
  const auto file = input.AsFile("boxes.json");
  IsAccepted(file, [&] { ReadCocoResults(file); });
  IsAccepted(file, [&] { ReadOaSlamBoxes(file, {"cup", "chair"}); });
});

}  // namespace
}  // namespace soslam
