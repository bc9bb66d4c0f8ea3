// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/dataset_checks.h"

namespace soslam {

namespace {

using Check = std::vector<Finding> (*)(const ImportView&);

void Append(const Check& check, const ImportView& view, std::vector<Finding>* findings) {
  const std::vector<Finding> more = check(view);
  findings->insert(findings->end(), more.begin(), more.end());
}

}  // namespace

std::vector<Finding> CheckDataset(const ImportView& view) {
  std::vector<Finding> findings;
  for (const Check check : {&CheckCamera, &CheckImages, &CheckBoxes})
    Append(check, view, &findings);
  // Boxes through a wrong camera, and wrong boxes, contradict the best poses, and those all
  // objects.
  for (const Check check : {&CheckPoses, &CheckObjects}) {
    if (findings.empty()) Append(check, view, &findings);
  }
  for (const Check check :
       {&CheckTruth, &CheckPlanes, &CheckScores, &CheckLabels, &CheckRejections}) {
    Append(check, view, &findings);
  }
  findings.insert(findings.begin(), view.content.findings.begin(), view.content.findings.end());
  return WorstFirst(std::move(findings));
}

}  // namespace soslam
