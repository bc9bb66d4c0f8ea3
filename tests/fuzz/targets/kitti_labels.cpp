// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/kitti_label.h"
#include "dataset/kitti_object.h"
#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

const FuzzTarget kKittiLabels("kitti_labels", [](const HostileInput& input) {
  const auto file = input.AsFile("000000.txt");
  IsAccepted(file, [&] { ReadKittiCalibration(file); });
  IsAccepted(file, [&] { ReadKittiTrackingLabels(file); });
  IsAccepted(file, [&] { ReadKittiObjectLabels(file); });
  IsAccepted(file, [&] { ReadKittiBoxes(file); });
});

}  // namespace
}  // namespace soslam
