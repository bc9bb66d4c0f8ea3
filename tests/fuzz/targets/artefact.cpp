// SPDX-License-Identifier: BSD-3-Clause
#include <optional>

#include "fuzz/fuzz_target.h"
#include "soslam/appearance/appearance_file.h"
#include "soslam/appearance/head.h"
#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/inspection/difference.h"
#include "soslam/inspection/inspection.h"
#include "soslam/priors/furniture_catalogue.h"
#include "soslam/synthesis/scene.h"

namespace soslam {
namespace {

// The sequence that the corpus `estimates` belongs to.
const Sequence& SequenceOfEstimates() {
  static const Sequence sequence =
      ReadSequence(SOSLAM_SOURCE_DIR "/tests/fuzz/corpus/sequence/of_estimates");
  return sequence;
}

// Any kind of JSON artefact.
const FuzzTarget kArtefacts("artefacts", [](const HostileInput& input) {
  const auto file = input.AsFile("artefact.json");
  IsAccepted(file, [&] { FormatInspection(Inspect(file, std::nullopt), false); });
  IsAccepted(file, [&] { Inspect(file, SequenceOfEstimates()); });
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
    const LandmarkEstimates landmarks = ReadLandmarks(file, SequenceOfEstimates());
    WriteLandmarks(input.Output("landmarks.json"), landmarks, SequenceOfEstimates(), {});
  });
  IsAccepted(file, [&] {
    const MapEstimate map = ReadMap(file, SequenceOfEstimates());
    WriteMap(input.Output("map.json"), map, SequenceOfEstimates(), {});
  });
});

const FuzzTarget kHdf5("hdf5", [](const HostileInput& input) {
  const auto file = input.AsFile("artefact.h5");
  IsAccepted(file, [&] { ReadArtefactHeader(file); });
  ReadBy(file, ReadSymmetry, ReadAppearance, [](const auto& path) { const Head head(path); });
  const auto points = input.Output("points.h5");
  if (IsAccepted(file, [&] { WritePoints(points, ReadPoints(file), {}); })) ReadPoints(points);
  const auto matches = input.Output("matches.h5");
  if (IsAccepted(file, [&] { WriteMatches(matches, ReadMatches(file), {}); })) ReadMatches(matches);
  IsAccepted(file, [&] {
    const EdgesReader reader(file);
    for (const int frame_id : reader.FrameIds()) reader.Read(frame_id);
  });
  IsAccepted(file, [&] { Inspect(file, std::nullopt); });
  IsAccepted(file, [&] { CompareArtefacts(file, file, 0.0); });
});

const FuzzTarget kSemanticTable("semantic_table", [](const HostileInput& input) {
  const auto file = input.AsFile("semantic_table.json");
  SemanticRows rows;
  IsAccepted(file, [&] { ReadSemanticTable(file); });
  if (!IsAccepted(file, [&] { rows = ReadSemanticRows(file); })) return;
  WriteSemanticRows(input.Output("semantic_table.json"), rows, {});
});

const FuzzTarget kCatalogue("catalogue", [](const HostileInput& input) {
  ReadBy(input.AsFile("catalogue"), ReadFurnitureCatalogue, ReadCatalogueNames);
});

const FuzzTarget kScene("scene", [](const HostileInput& input) {
  ReadBy(input.AsFile("scene.json"), ReadScene);
});

}  // namespace
}  // namespace soslam
