// SPDX-License-Identifier: BSD-3-Clause
#include <optional>

#include "artefact/landmarks_file.h"
#include "artefact/sequence_file.h"
#include "fuzz/fuzz_target.h"
#include "inspection/difference.h"
#include "inspection/inspection.h"

namespace soslam {
namespace {

// The sequence that tests/golden/{landmarks,map}-1.1.json belong to.
const Sequence& GoldenSequence() {
  static const Sequence sequence =
      ReadSequence(SOSLAM_SOURCE_DIR "/tests/golden/sequence-1.1.json");
  return sequence;
}

// Any kind of JSON artefact.
const FuzzTarget kArtefacts("artefacts", [](const HostileInput& input) {
  const auto file = input.AsFile("artefact.json");
  IsAccepted(file, [&] { FormatInspection(Inspect(file, std::nullopt), false); });
  IsAccepted(file, [&] { Inspect(file, GoldenSequence()); });
  IsAccepted(file, [&] { CompareArtefacts(file, file, 0.0); });
});

const FuzzTarget kSequence("sequence", [](const HostileInput& input) {
  const auto file = input.AsFile("sequence.json");
  IsAccepted(file, [&] { ReadSequence(file); });
  IsAccepted(file, [&] { Inspect(file, std::nullopt); });
  Sequence sequence;
  if (!IsAccepted(file, [&] { sequence = ReadSequence(file, PlaneNeed::kNotNeeded); })) return;
  WriteSequence(input.Output("sequence.json"), sequence, {});
});

const FuzzTarget kEstimates("estimates", [](const HostileInput& input) {
  const auto file = input.AsFile("estimates.json");
  IsAccepted(file, [&] {
    const LandmarkEstimates landmarks = ReadLandmarks(file, GoldenSequence());
    WriteLandmarks(input.Output("landmarks.json"), landmarks, GoldenSequence(), {});
  });
  IsAccepted(file, [&] {
    const MapEstimate map = ReadMap(file, GoldenSequence());
    WriteMap(input.Output("map.json"), map, GoldenSequence(), {});
  });
});

}  // namespace
}  // namespace soslam
