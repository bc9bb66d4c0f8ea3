// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/kinds.h"

#include <algorithm>

#include "soslam/artefact/json_file.h"
#include "soslam/image/frames_record.h"
#include "soslam/model/associations.h"
#include "soslam/model/describe_estimates.h"
#include "soslam/model/describe_metrics.h"
#include "soslam/model/describe_sequence.h"
#include "soslam/model/image_turns.h"
#include "soslam/model/reconstruction.h"
#include "soslam/model/semantic_table.h"
#include "soslam/model/world.h"

namespace soslam {
namespace {

template <typename Body>
ArtefactKind MakeKind(const char* name, const char* title) {
  return {name, title, [] { return SchemaWriter::Of<Artefact<Body>>(); },
          [](const nlohmann::json& document) { DescribedFromJson<Artefact<Body>>(document); }};
}

// Tables written by people have no header.
nlohmann::ordered_json SemanticTableSchema() {
  auto schema = SchemaWriter::Of<Artefact<SemanticRows>>();
  schema["required"] = {"labels"};
  return schema;
}

}  // namespace

const std::vector<ArtefactKind>& ArtefactKinds() {
  static const std::vector<ArtefactKind> kinds = {
      MakeKind<Associations>("associations", "which detections are of the same object, and why"),
      MakeKind<FramesRecord>("frames", "images chosen from photos or a video"),
      MakeKind<LandmarkEstimates>("landmarks", "estimated landmarks"),
      MakeKind<MapEstimate>("map", "landmarks and trajectory of the back end"),
      MakeKind<Metrics>("metrics", "errors against ground truth"),
      MakeKind<PlanesReport>("planes", "estimated support planes"),
      MakeKind<ReconstructionSummary>("reconstruction",
                                      "poses, camera and points by structure from motion"),
      {"semantic_table", "sizes and shapes by label", &SemanticTableSchema,
       [](const nlohmann::json& document) { DescribedFromJson<Artefact<SemanticRows>>(document); }},
      MakeKind<Sequence>("sequence", "a dataset, checked and gated"),
      MakeKind<ImageTurns>("turns", "what a detector finds in turned images"),
      MakeKind<WorldReport>("world", "up, scale and support planes of a world that had neither")};
  return kinds;
}

const ArtefactKind* FindArtefactKind(const std::string& name) {
  const auto kind = std::ranges::find(ArtefactKinds(), name, &ArtefactKind::name);
  return kind == ArtefactKinds().end() ? nullptr : &*kind;
}

std::string SchemaText(const std::string& title, const std::string& description,
                       const nlohmann::ordered_json& schema) {
  nlohmann::ordered_json document = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                                     {"title", title},
                                     {"description", description}};
  document.update(schema);
  return document.dump(2) + "\n";
}

}  // namespace soslam
