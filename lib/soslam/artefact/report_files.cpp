// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/files.h"
#include "soslam/model/describe_metrics.h"

namespace soslam {

constexpr const char* kAssociationsKind = "associations";

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

constexpr const char* kWorldKind = "world";

void WriteWorld(const std::filesystem::path& path, const WorldReport& report,
                const ArtefactInfo& info) {
  WriteArtefact(path, kWorldKind, info, DescribedToJson(report));
}

Artefact<WorldReport> ReadWorld(const std::filesystem::path& path) {
  return ReadDescribed<WorldReport>(path, kWorldKind);
}

constexpr const char* kTurnsKind = "turns";

void WriteTurns(const std::filesystem::path& path, const ImageTurns& turns,
                const ArtefactInfo& info) {
  WriteArtefact(path, kTurnsKind, info, DescribedToJson(turns));
}

Artefact<ImageTurns> ReadTurns(const std::filesystem::path& path) {
  return ReadDescribed<ImageTurns>(path, kTurnsKind);
}

constexpr const char* kReconstructionKind = "reconstruction";

void WriteReconstruction(const std::filesystem::path& path, const ReconstructionSummary& summary,
                         const ArtefactInfo& info) {
  WriteArtefact(path, kReconstructionKind, info, DescribedToJson(summary));
}

Artefact<ReconstructionSummary> ReadReconstruction(const std::filesystem::path& path) {
  return ReadDescribed<ReconstructionSummary>(path, kReconstructionKind);
}

void WriteMetrics(const std::filesystem::path& path, const Metrics& metrics,
                  const Sequence& sequence, const ArtefactInfo& info) {
  ArtefactInfo with_findings = info;
  if (metrics.map_quality) with_findings.findings = metrics.map_quality->alignments.findings;
  WriteArtefact(path, "metrics", with_findings, DescribedToJson(metrics, &sequence));
}

}  // namespace soslam
