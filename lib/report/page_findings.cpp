// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "artefact/json_file.h"
#include "base/error.h"
#include "report/page_html.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Artefacts in the order in which stages write them.
constexpr std::array kArtefacts = {"sequence.json", "associations.json", "planes.json",
                                   "initial.json",  "refined.json",      "map.json",
                                   "metrics.json"};
constexpr std::array kTexts = {"severity", "check", "found", "expected", "cause", "remedy"};

// Empty for a file that cannot be read; the page lists such files elsewhere.
json FindingsIn(const fs::path& file) {
  try {
    const json document = ParseJsonFile(file);
    return document.is_object() ? document.value("findings", json::array()) : json::array();
  } catch (const InputError&) {
    return json::array();
  }
}

json TextsOf(const json& finding) {
  json texts;
  for (const char* key : kTexts) {
    const json text = finding.is_object() ? finding.value(key, json()) : json();
    texts[key] = text.is_string() ? Utf8(text.get<std::string>()) : "";
  }
  return texts;
}

}  // namespace

json PageFindings(const DatasetResult& dataset) {
  std::map<fs::path, json> findings_of;  // by resolved path
  json findings = json::array();
  for (const char* artefact : kArtefacts) {
    std::vector<std::pair<json, std::vector<std::string>>> found;  // with the variants' names
    for (const VariantResult& variant : dataset.variants) {
      const fs::path file = fs::weakly_canonical(variant.folder / artefact);
      if (!findings_of.contains(file)) findings_of[file] = FindingsIn(file);
      for (const json& finding : findings_of[file]) {
        const json texts = TextsOf(finding);
        auto known = std::ranges::find(found, texts, [](const auto& pair) { return pair.first; });
        if (known == found.end()) known = found.emplace(known, texts, std::vector<std::string>());
        known->second.push_back(Utf8(variant.name));
      }
    }
    for (auto& [finding, variants] : found) {
      const bool in_all = variants.size() == dataset.variants.size();
      finding["where"] =
          fmt::format("{} of {}", artefact,
                      in_all ? "all variants" : fmt::to_string(fmt::join(variants, ", ")));
      findings.push_back(finding);
    }
  }
  std::stable_partition(findings.begin(), findings.end(),
                        [](const json& finding) { return finding["severity"] == "error"; });
  return findings;
}

std::string FindingsHtml(const json& findings) {
  if (findings.empty()) return "";
  std::string items;
  for (const json& finding : findings) {
    const auto text = [&](const char* key) { return HtmlText(finding.at(key).get<std::string>()); };
    items += fmt::format(
        "<li class=\"{}\"><strong>{}: {}</strong> <span class=\"faint\">({}, "
        "{})</span><br>expected: "
        "{}<br>likely cause: {}<br>remedy: {}</li>\n",
        text("severity"), text("severity"), text("found"), text("check"), text("where"),
        text("expected"), text("cause"), text("remedy"));
  }
  return "<h3>Findings</h3>\n<ul class=\"findings\">\n" + items + "</ul>\n";
}

}  // namespace soslam
