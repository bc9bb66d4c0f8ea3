// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/dataset_checks.h"

#include <algorithm>

namespace soslam {

namespace {

using Check = std::vector<Finding> (*)(const ImportView&);

void Append(const Check& check, const ImportView& view, std::vector<Finding>* findings) {
  const std::vector<Finding> more = check(view);
  findings->insert(findings->end(), more.begin(), more.end());
}

// Findings on objects and planes when poses or frame order are wrong: they get that as their cause.
void AppendThroughWrongPoses(const ImportView& view, std::vector<Finding>* findings) {
  for (const Check check : {&CheckObjects, &CheckPlanes}) {
    for (Finding finding : check(view)) {
      finding.cause = "what contradicts the boxes, rather than objects or planes";
      finding.remedy = "mend poses, order of frames or ids first";
      findings->push_back(std::move(finding));
    }
  }
}

}  // namespace

std::vector<Finding> CheckDataset(const ImportView& view) {
  std::vector<Finding> findings;
  for (const Check check : {&CheckCamera, &CheckImages, &CheckBoxes})
    Append(check, view, &findings);
  // Boxes with a wrong camera, and wrong boxes, contradict even the best poses; wrong poses
  // contradict objects and planes.
  const auto has = [&](auto field, const auto& value) {
    return std::ranges::find(findings, value, field) != findings.end();
  };
  if (!has(&Finding::severity, Severity::kError)) Append(&CheckPoses, view, &findings);
  if (!has(&Finding::severity, Severity::kError) && !has(&Finding::check, kPoseConvention)) {
    if (has(&Finding::check, kBoxesAgainstPoses) || has(&Finding::check, kFrameOrder)) {
      AppendThroughWrongPoses(view, &findings);
    } else {
      for (const Check check : {&CheckObjects, &CheckPlanes}) Append(check, view, &findings);
    }
    Append(&CheckObjectAxes, view, &findings);
  }
  for (const Check check : {&CheckTruth, &CheckScores, &CheckLabels, &CheckRejections}) {
    Append(check, view, &findings);
  }
  findings.insert(findings.begin(), view.content.findings.begin(), view.content.findings.end());
  return WorstFirst(std::move(findings));
}

}  // namespace soslam
