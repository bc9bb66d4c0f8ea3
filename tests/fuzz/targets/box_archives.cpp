// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/yolo_boxes.h"
#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

const FuzzTarget kBoxArchives("box_archives", [](const HostileInput& input) {
  const auto archive = input.AsFile("boxes.zip");
  IsAccepted(archive, [&] { ReadNormalisedYoloBoxes(archive, {"cup", "chair"}, 640, 480); });
  IsAccepted(archive, [&] { ReadPixelYoloBoxes(archive, {"cup", "chair"}); });
});

}  // namespace
}  // namespace soslam
