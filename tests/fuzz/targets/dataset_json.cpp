// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/dataset_json.h"

#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

const FuzzTarget kDatasetJson("dataset_json", [](const HostileInput& input) {
  const auto file = input.AsFile("dataset.json");
  IsAccepted(file, [&] { ReadCamera(file); });
  IsAccepted(file, [&] { ReadCamera(file, CameraYAxis::kUp); });
  IsAccepted(file, [&] { ReadPlanes(file); });
  IsAccepted(file, [&] { ReadObjects(file); });
});

}  // namespace
}  // namespace soslam
