// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/fuzz_target.h"
#include "synthesis/scene_file.h"

namespace soslam {
namespace {

const FuzzTarget kScene("scene", [](const HostileInput& input) {
  const auto file = input.AsFile("scene.json");
  IsAccepted(file, [&] { ReadScene(file); });
});

}  // namespace
}  // namespace soslam
