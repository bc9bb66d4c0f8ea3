// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <utility>

#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/model/describe_sequence.h"

namespace soslam {

constexpr const char* kSequenceKind = "sequence";

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

}  // namespace soslam
