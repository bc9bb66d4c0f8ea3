// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/class_names.h"
#include "dataset/labelled_box.h"
#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

const FuzzTarget kDetectionsCsv("detections_csv", [](const HostileInput& input) {
  const auto file = input.AsFile("detections.csv");
  IsAccepted(file, [&] { ReadDetectionsCsv(file); });
  IsAccepted(file, [&] { ReadLabelFile(file); });
  const auto yaml = input.AsFile("data.yaml");
  IsAccepted(yaml, [&] { ReadLabelFile(yaml); });
});

}  // namespace
}  // namespace soslam
