// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/files.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/model/describe_estimates.h"
#include "soslam/model/describe_metrics.h"
#include "soslam/model/describe_sequence.h"

namespace soslam {
namespace {

constexpr const char* kAssociationsKind = "associations";
constexpr const char* kLandmarksKind = "landmarks";
constexpr const char* kMapKind = "map";
constexpr const char* kReconstructionKind = "reconstruction";
constexpr const char* kSemanticTableKind = "semantic_table";
constexpr const char* kSequenceKind = "sequence";
constexpr const char* kTurnsKind = "turns";
constexpr const char* kWorldKind = "world";

}  // namespace

Sequence ReadSequence(const std::filesystem::path& path, PlaneNeed need) {
  auto [header, findings, sequence] = ReadDescribed<Sequence>(path, kSequenceKind);
  sequence.findings = std::move(findings);
  if (need == PlaneNeed::kNeeded && sequence.planes.empty()) {
    throw InputError(fmt::format(
        "{}: has no support planes; expected those of planes.json in the dataset, or estimated "
        "ones: settings {{\"planes\": {{\"planes\": \"estimated\"}}}}",
        path.string()));
  }
  if (need == PlaneNeed::kNeeded && !sequence.HasSupports()) {
    throw InputError(fmt::format(
        "{}: it is not known on which of the {} support planes its objects stand; expected "
        "support_plane of each object in objects.json, or association that finds it: settings "
        "{{\"associate\": {{\"association\": \"estimated\"}}}}",
        path.string(), sequence.planes.size()));
  }
  return sequence;
}

void WriteSequence(const std::filesystem::path& path, const Sequence& sequence,
                   const ArtefactInfo& info) {
  ArtefactInfo with_findings = info;
  with_findings.findings = sequence.findings;
  WriteArtefact(path, kSequenceKind, with_findings, DescribedToJson(sequence, &sequence));
}

void WriteReconstruction(const std::filesystem::path& path, const ReconstructionSummary& summary,
                         const ArtefactInfo& info) {
  WriteArtefact(path, kReconstructionKind, info, DescribedToJson(summary));
}

Artefact<ReconstructionSummary> ReadReconstruction(const std::filesystem::path& path) {
  return ReadDescribed<ReconstructionSummary>(path, kReconstructionKind);
}

void WriteAssociations(const std::filesystem::path& path, const Associations& associations,
                       const ArtefactInfo& info) {
  WriteArtefact(path, kAssociationsKind, info, DescribedToJson(associations));
}

Artefact<Associations> ReadAssociations(const std::filesystem::path& path) {
  return ReadDescribed<Associations>(path, kAssociationsKind);
}

Edits ReadEdits(const std::filesystem::path& path) {
  Edits edits = ReadDocument<Edits>(ParseJsonFile(path), path.string());
  edits.file = path.string();
  return edits;
}

void WritePlanes(const std::filesystem::path& path, const PlanesReport& report,
                 const ArtefactInfo& info) {
  WriteArtefact(path, "planes", info, DescribedToJson(report));
}

void WriteTurns(const std::filesystem::path& path, const ImageTurns& turns,
                const ArtefactInfo& info) {
  WriteArtefact(path, kTurnsKind, info, DescribedToJson(turns));
}

Artefact<ImageTurns> ReadTurns(const std::filesystem::path& path) {
  return ReadDescribed<ImageTurns>(path, kTurnsKind);
}

void WriteWorld(const std::filesystem::path& path, const WorldReport& report,
                const ArtefactInfo& info) {
  WriteArtefact(path, kWorldKind, info, DescribedToJson(report));
}

Artefact<WorldReport> ReadWorld(const std::filesystem::path& path) {
  return ReadDescribed<WorldReport>(path, kWorldKind);
}

SemanticTable ReadSemanticTable(const std::filesystem::path& path) {
  const SemanticRows rows = ReadSemanticRows(path);
  try {
    return LookUpTable(rows);
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

SemanticRows ReadSemanticRows(const std::filesystem::path& path) {
  const nlohmann::json document = ParseJsonFile(path);
  // Tables written by people have no header.
  const bool has_header = document.is_object() && document.contains("artefact");
  return has_header ? ReadDescribed<SemanticRows>(path, kSemanticTableKind).body
                    : ReadDocument<SemanticRows>(document, path.string());
}

void WriteSemanticRows(const std::filesystem::path& path, const SemanticRows& rows,
                       const ArtefactInfo& info) {
  WriteArtefact(path, kSemanticTableKind, info, DescribedToJson(rows));
}

LandmarkEstimates ReadLandmarks(const std::filesystem::path& path, const Sequence& sequence) {
  return ReadDescribed<LandmarkEstimates>(path, kLandmarksKind, &sequence).body;
}

void WriteLandmarks(const std::filesystem::path& path, const LandmarkEstimates& estimates,
                    const Sequence& sequence, const ArtefactInfo& info) {
  WriteArtefact(path, kLandmarksKind, info, DescribedToJson(estimates, &sequence));
}

MapEstimate ReadMap(const std::filesystem::path& path, const Sequence& sequence) {
  return ReadDescribed<MapEstimate>(path, kMapKind, &sequence).body;
}

void WriteMap(const std::filesystem::path& path, const MapEstimate& map, const Sequence& sequence,
              const ArtefactInfo& info) {
  if (map.world_from_camera.size() != sequence.frames.size() ||
      map.planes_in_world.size() != sequence.planes.size()) {
    throw std::logic_error("the map has other frames or planes than its sequence");
  }
  WriteArtefact(path, kMapKind, info, DescribedToJson(map, &sequence));
}

void WriteMetrics(const std::filesystem::path& path, const Metrics& metrics,
                  const Sequence& sequence, const ArtefactInfo& info) {
  ArtefactInfo with_findings = info;
  if (metrics.map_quality) with_findings.findings = metrics.map_quality->alignments.findings;
  WriteArtefact(path, "metrics", with_findings, DescribedToJson(metrics, &sequence));
}

}  // namespace soslam
