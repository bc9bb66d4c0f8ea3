// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/yolo_boxes.h"
#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

const FuzzTarget kBoxArchives("box_archives", [](const HostileInput& input) {
  const auto archive = input.AsFile("boxes.zip");
  YoloTexts texts;
  if (!IsAccepted(archive, [&] { texts = ReadYoloTexts(archive); })) return;
  RejectionCounts mended;
  IsAccepted(archive, [&] { ReadNormalisedYoloBoxes(texts, {"cup", "chair"}, 640, 480, &mended); });
  IsAccepted(archive, [&] { ReadPixelYoloBoxes(texts, {"cup", "chair"}); });
});

}  // namespace
}  // namespace soslam
