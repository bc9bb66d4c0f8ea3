// SPDX-License-Identifier: BSD-3-Clause
#include "report/dataset_facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "artefact/json_file.h"
#include "artefact/sequence_file.h"
#include "base/paths.h"
#include "base/table.h"
#include "base/text.h"

namespace soslam {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(DatasetFacts, boxes_of, boxes, annotation,
                                                partly_annotated, published, differs)

void ReadAbout(const std::filesystem::path& settings, DatasetFacts* facts) {
  if (!Exists(settings)) return;
  const nlohmann::json document = ParseJsonFile(settings);
  const nlohmann::json about =
      document.is_object() ? document.value("about", nlohmann::json()) : nlohmann::json();
  if (about.is_null()) return;
  ValidateAgainstSchema(about, "about", settings.string() + ": about");
  about.get_to(*facts);
}

void CountSequence(const std::filesystem::path& sequence, DatasetFacts* facts) {
  const Sequence read = ReadSequence(sequence, PlaneNeed::kNotNeeded);
  DatasetCounts counts = {static_cast<int>(read.frames.size() + read.held_out.size())};
  for (const TrueObject& object : read.true_objects) {
    if (!object.IsWanted()) continue;
    ++counts.objects;
    counts.round_objects += object.truth.rotationally_symmetric ? 1 : 0;
  }
  facts->counts = counts;
  facts->odometry = read.odometry_source;
}

std::string MarksOf(const DatasetFacts& facts, int objects) {
  std::vector<std::string> marks;
  if (objects <= kFewObjects) marks.emplace_back("f");
  if (facts.partly_annotated) marks.emplace_back("p");
  if (facts.counts && facts.counts->round_objects > 0) marks.emplace_back("r");
  return marks.empty() ? kNoValue : fmt::format("{}", fmt::join(marks, ", "));
}

std::string MarksNote() {
  return fmt::format(
      "Marks: f, few objects (at most {}); p, partly annotated: there are more things of such "
      "kinds; r, some objects have a round footprint: they have no Rot, and their true boxes take "
      "the yaw of the estimate.",
      kFewObjects);
}

std::string DifferencesInWords(const DatasetFacts& facts) {
  std::vector<std::string> parts;
  if (!facts.differs.empty()) parts.push_back(facts.differs);
  if (facts.counts) {
    parts.push_back(Counted(facts.counts->frames, "frame") + ", " +
                    Counted(facts.counts->objects, "annotated object"));
  }
  const auto add = [&](const char* what, const std::string& text) {
    if (!text.empty()) parts.push_back(fmt::format("{}: {}", what, text));
  };
  add("annotation", facts.annotation);
  add("boxes", facts.boxes);
  add("odometry", facts.odometry);
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace soslam
