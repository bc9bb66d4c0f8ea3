// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/inspection.h"

#include <fmt/color.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <sstream>
#include <string_view>

#include "artefact/hdf5_artefact.h"
#include "artefact/model_json.h"
#include "base/error.h"
#include "base/one_line.h"
#include "base/table.h"
#include "inspection/kinds.h"
#include "inspection/provenance.h"

namespace soslam {
namespace {

constexpr size_t kLineWidth = 100;

using Reader = std::function<Inspection(const std::filesystem::path& file,
                                        const std::optional<Sequence>& sequence)>;

struct Kind {
  const char* name;
  const char* title;
  Reader read;
};

template <typename Function>
Reader WithoutSequence(Function function) {
  return [function](const auto& file, const auto&) { return function(file); };
}

const std::vector<Kind>& Kinds() {
  static const std::vector<Kind> kinds = {
      {"associations", "which detections are of the same object, and why",
       WithoutSequence(&InspectAssociations)},
      {"edges", "edges, distances and corners of images", WithoutSequence(&InspectEdges)},
      {"landmarks", "estimated landmarks", &InspectLandmarks},
      {"map", "landmarks and trajectory of the back end", &InspectMap},
      {"metrics", "errors against ground truth", WithoutSequence(&InspectMetrics)},
      {"planes", "estimated support planes", WithoutSequence(&InspectPlanes)},
      {"semantic_table", "sizes and shapes by label", WithoutSequence(&InspectSemanticTable)},
      {"sequence", "a dataset, checked and gated", WithoutSequence(&InspectSequence)},
      {"symmetry", "what symmetry and edges say about the yaw of observations", &InspectSymmetry}};
  return kinds;
}

const Kind& FindKind(std::string_view name, const std::filesystem::path& file) {
  const auto found = std::ranges::find(Kinds(), name, &Kind::name);
  if (found != Kinds().end()) return *found;
  std::vector<std::string> known;
  for (const Kind& kind : Kinds()) known.emplace_back(kind.name);
  throw InputError(fmt::format("{}: artefact kind is \"{}\"; expected one of {}", file.string(),
                               name, fmt::join(known, ", ")));
}

std::vector<Fact> FindingFacts(const std::filesystem::path& file) {
  std::vector<Fact> facts;
  if (IsHdf5(file)) return facts;
  for (const Finding& finding : FindingsFromJson(ParseJsonFile(file))) {
    facts.push_back(
        {kSeverityNames[static_cast<size_t>(finding.severity)], OneLine(InWords(finding))});
  }
  return facts;
}

// Breaks a text between words where it is too wide; lines after the first are indented.
std::string Wrapped(const std::string& text, size_t indent) {
  std::istringstream words(text);
  std::string wrapped;
  size_t column = indent;
  for (std::string word; words >> word; column += WidthOf(word)) {
    if (column > indent && column + 1 + WidthOf(word) > kLineWidth) {
      wrapped += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      wrapped += ' ';
      ++column;
    }
    wrapped += word;
  }
  return wrapped;
}

}  // namespace

Inspection Inspect(const std::filesystem::path& file, const std::optional<Sequence>& sequence) {
  const nlohmann::json header = ReadArtefactHeader(file);
  const Kind& kind = FindKind(header.at("kind").get_ref<const std::string&>(), file);
  CheckArtefactHeader(header, kind.name, file.string());
  Inspection inspection = kind.read(file, sequence);
  inspection.title = fmt::format("{}: {} ({})", file.string(), kind.name, kind.title);
  try {
    const std::vector<Fact> provenance = Provenance(header);
    inspection.facts.insert(inspection.facts.begin(), provenance.begin(), provenance.end());
    std::ranges::move(FindingFacts(file), std::back_inserter(inspection.facts));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(
        fmt::format("{}: the artefact header is not as expected: {}", file.string(), error.what()));
  }
  return inspection;
}

std::string FormatInspection(const Inspection& inspection, bool is_coloured) {
  const auto styled = [&](fmt::emphasis emphasis, const std::string& text) {
    return is_coloured ? fmt::format(fmt::text_style(emphasis), "{}", text) : text;
  };
  size_t width = 0;
  for (const Fact& fact : inspection.facts) width = std::max(width, WidthOf(fact.name));
  std::string text = styled(fmt::emphasis::bold, inspection.title) + "\n";
  for (const Fact& fact : inspection.facts) {
    const std::string name = fact.name + std::string(width - WidthOf(fact.name), ' ');
    constexpr size_t kMargin = 2;
    text += fmt::format("  {}  {}\n", styled(fmt::emphasis::faint, name),
                        Wrapped(fact.text, kMargin + width + kMargin));
  }
  if (inspection.table.rows.empty()) return text;
  return text + "\n" + FormatTable(inspection.table, is_coloured);
}

std::string CountsInWords(const std::map<std::string, int>& counts) {
  std::vector<std::pair<std::string, int>> sorted(counts.begin(), counts.end());
  std::ranges::stable_sort(sorted, std::greater{}, &std::pair<std::string, int>::second);
  std::vector<std::string> words;
  for (const auto& [name, count] : sorted) words.push_back(fmt::format("{} {}", count, name));
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

Value LabelOf(const std::optional<Sequence>& sequence, int object_id) {
  if (!sequence) return {};
  const auto found = std::ranges::lower_bound(sequence->objects, object_id, {}, &Object::id);
  if (found == sequence->objects.end() || found->id != object_id) return {};
  return found->label;
}

}  // namespace soslam
