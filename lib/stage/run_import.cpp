// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_import.h"

#include <fmt/format.h>

#include "artefact/sequence_file.h"
#include "cli/report_findings.h"
#include "dataset/gate.h"
#include "dataset/import.h"

namespace soslam {

void RunImport(const ImportOptions& options, const StageFiles& files, int /*threads*/) {
  const auto& folder = files.at("dataset");
  std::vector<std::filesystem::path> inputs;
  const Sequence sequence = ImportDataset(folder, options, &inputs);
  ReportFindings("import", sequence.findings);
  WriteSequence(files.at("output"), sequence, {OptionsToJson(options), inputs});
  fmt::print("{}: {} frames, {} objects, {} detections used, {}\n", sequence.name,
             sequence.frames.size(), sequence.objects.size(), sequence.detections.size(),
             DescribeRejections(sequence.rejected_detections));
}

}  // namespace soslam
