// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/colmap_model.h"
#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

// A folder is a model as text, as the files of a folder end with a line.
const FuzzTarget kColmap("colmap", [](const HostileInput& input) {
  const auto folder = input.AsFolder();
  IsAccepted(folder, [&] { ReadColmapModel(folder); });
  const auto file = input.AsFile("model.bin");
  IsAccepted(file, [&] { ReadColmapCamera(file); });
  IsAccepted(file, [&] { ReadColmapPoses(file); });
  IsAccepted(file, [&] { ReadColmapPoints(file); });
});

}  // namespace
}  // namespace soslam
