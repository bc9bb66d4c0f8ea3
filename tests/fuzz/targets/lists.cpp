// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/trajectories.h"
#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

const FuzzTarget kLists("lists", [](const HostileInput& input) {
  const auto file = input.AsFile("rgb.txt");
  IsAccepted(file, [&] { ReadImageList(file); });
  IsAccepted(file, [&] { ReadPairedImageList(file, PairOrder::kImageFirst); });
  IsAccepted(file, [&] { ReadPairedImageList(file, PairOrder::kImageSecond); });
});

}  // namespace
}  // namespace soslam
