// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/fuzz_target.h"
#include "image/read_image.h"

namespace soslam {
namespace {

const FuzzTarget kImage("image", [](const HostileInput& input) {
  const auto file = input.AsFile("image.png");
  IsAccepted(file, [&] { ReadGreyImage(file, 60, 40); });
  IsAccepted(file, [&] { ReadColourImage(file); });
});

}  // namespace
}  // namespace soslam
