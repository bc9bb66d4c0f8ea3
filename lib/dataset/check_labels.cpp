// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "dataset/dataset_checks.h"

namespace soslam {
namespace {

// Number of detections whose label is in objects.json, with their class numbers increased by
// `shift`.
int CountKnown(const ImportView& view, const std::set<std::string>& known, int shift) {
  const std::vector<std::string>& names = view.content.class_names;
  return static_cast<int>(std::ranges::count_if(view.content.rows, [&](const DetectionRow& row) {
    if (shift == 0) return known.contains(row.label);
    const auto found = std::ranges::find(names, row.label);
    const auto index = std::distance(names.begin(), found) + shift;
    return found != names.end() && index >= 0 && index < std::ssize(names) &&
           known.contains(names[static_cast<size_t>(index)]);
  }));
}

// Finds class numbers that count from 1 where the list counts from 0, or the reverse.
std::vector<Finding> CheckClassNumbers(const ImportView& view) {
  constexpr int kFewest = 10;
  std::set<std::string> known;
  for (const Object& object : view.content.objects) {
    if (object.ground_truth) known.insert(object.label);
  }
  const auto all = static_cast<int>(view.content.rows.size());
  const int as_read = CountKnown(view, known, 0);
  if (view.content.class_names.empty() || all < kFewest || 3 * as_read > all) return {};
  for (const int shift : {-1, 1}) {
    const int shifted = CountKnown(view, known, shift);
    if (3 * shifted < 2 * all) continue;
    return {
        {"class_numbers", Severity::kWarning,
         fmt::format("{} of {} detections have a label of objects.json, but {} if their classes "
                     "are counted one {}",
                     as_read, all, shifted, shift < 0 ? "lower" : "higher"),
         "classes numbered as in the list of their names",
         shift < 0 ? "classes counted from 1, or a name too many in front of the list"
                   : "classes counted from 0, or a name missing in front of the list",
         "give the list of names that the detector was trained with: class_names"}};
  }
  return {};
}

// Finds blank lines between names, which count as classes for programs that identify names by line.
std::vector<Finding> CheckBlankLines(const ImportView& view) {
  const auto& file = view.content.class_names_file;
  if (!file || file->extension() == ".yaml" || file->extension() == ".yml") return {};
  std::ifstream stream(*file);
  int blank = 0;
  int between = 0;
  for (std::string line; std::getline(stream, line);) {
    const bool is_blank = line.find_first_not_of(" \t\r") == line.npos;
    if (!is_blank) between = blank;
    if (is_blank) ++blank;
  }
  if (between == 0) return {};
  return {
      {"class_names", Severity::kWarning,
       fmt::format("{} has {} blank lines before or between its names", file->filename().string(),
                   between),
       "one name a line, as blank lines do not count as classes",
       "a name that was deleted, which shifts all classes after it",
       "put a name in each blank line, or take the line away where classes were numbered without "
       "it"}};
}

}  // namespace

std::vector<Finding> CheckLabels(const ImportView& view) {
  std::vector<Finding> findings = CheckClassNumbers(view);
  const std::vector<Finding> of_file = CheckBlankLines(view);
  findings.insert(findings.end(), of_file.begin(), of_file.end());
  return findings;
}

}  // namespace soslam
