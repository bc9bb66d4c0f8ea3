// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_associate.h"

#include <fmt/format.h>

#include <array>

#include "artefact/associations_file.h"
#include "artefact/semantic_table_file.h"
#include "artefact/sequence_file.h"
#include "association/agreement.h"
#include "association/association.h"
#include "base/error.h"
#include "cli/report_findings.h"
#include "evaluation/result_checks.h"

namespace soslam {
namespace {

// Summary of the tracks' fates: "12 object, 3 merged".
std::string DescribeTracks(const Association& association) {
  std::array<int, kTrackFateNames.size()> counts{};
  for (const Track& track : association.tracks) ++counts.at(static_cast<size_t>(track.fate));
  std::string text;
  for (size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", kTrackFateNames[i], counts[i]);
  }
  return text.empty() ? "none" : text;
}

// Finding of the first segment whose up direction is ambiguous.
std::vector<Finding> CheckUpOfSegments(const Association& association) {
  std::vector<Finding> findings;
  for (const auto& [segment, up] : association.up_of_segments) {
    findings = CheckUp(up.holding, up.holdings, up.holding_tilt_variance);
    if (!findings.empty()) break;
  }
  return findings;
}

}  // namespace

void RunAssociate(const AssociateOptions& options, const StageFiles& files, int threads) {
  if (options.association == AssociationSource::kGiven) {
    throw SettingsError(
        "setting 'association' is 'given', which leaves nothing to do; expected 'estimated'");
  }
  Sequence sequence = ReadSequence(files.at("sequence"), PlaneNeed::kNotNeeded);
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  if (!options.use_planes) sequence = WithoutPlanes(std::move(sequence));
  const Association association = Associate(sequence, table, options, threads);
  if (association.objects.empty()) {
    throw NothingUsableError(fmt::format("{}: no object in {} detections; tracks: {}",
                                         files.at("sequence").string(), sequence.detections.size(),
                                         DescribeTracks(association)));
  }
  const Agreement agreement = CompareWithGiven(sequence, association, options.min_observations);
  const ArtefactInfo info = {OptionsToJson(options),
                             {files.at("sequence"), files.at("table")},
                             CheckUpOfSegments(association)};
  const Sequence associated = AssociatedSequence(sequence, association, agreement);
  ReportFindings("associate", info.findings);
  WriteAssociations(files.at("associations"), sequence, association, agreement, info);
  WriteSequence(files.at("output"), associated, info);
  fmt::print("{} objects with {} of {} detections; tracks: {}\n", association.objects.size(),
             associated.detections.size(), sequence.detections.size(), DescribeTracks(association));
  if (const auto f1 = agreement.F1()) {
    fmt::print("{} of {} given objects found; F1 {:.3f}\n", agreement.matched,
               agreement.given_objects, *f1);
  }
}

}  // namespace soslam
