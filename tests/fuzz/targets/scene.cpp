// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/scene.h"

#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

const FuzzTarget kScene("scene", [](const HostileInput& input) {
  const auto file = input.AsFile("scene.json");
  IsAccepted(file, [&] { ReadScene(file); });
});

}  // namespace
}  // namespace soslam
