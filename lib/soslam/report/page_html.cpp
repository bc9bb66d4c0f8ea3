// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/report/page_html.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"

namespace soslam {
namespace {

using nlohmann::json;

// The text with each {{name}} replaced by its value; values are not searched for names.
std::string Filled(std::string_view text, const std::map<std::string, std::string>& values) {
  std::string filled;
  for (size_t begin = text.find("{{"); begin != std::string_view::npos; begin = text.find("{{")) {
    const size_t end = text.find("}}", begin);
    filled += text.substr(0, begin);
    filled += values.at(std::string(text.substr(begin + 2, end - begin - 2)));
    text.remove_prefix(end + 2);
  }
  return filled += text;
}

std::string Escaped(const std::string& text, char what, std::string_view by) {
  std::string escaped;
  for (const char c : text) escaped += c == what ? by : std::string_view(&c, 1);
  return escaped;
}

}  // namespace

std::string Utf8(const std::string& bytes) {
  return json::parse(JsonText(bytes)).get<std::string>();
}

std::string EncodeUrl(const std::string& name) {
  std::string url;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = byte < 0x80 && (std::isalnum(byte) != 0 || c == '-' || c == '_');
    url += is_plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return url;
}

std::string PageText(const json& data) {
  return Escaped(JsonText(data), '<', "\\u003c");  // '<' would begin or end elements
}

std::string WithBlanks(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::string ObjectName(const std::string& label, int id) { return fmt::format("{} {}", label, id); }

std::string HtmlText(const std::string& text) {
  std::string escaped = Escaped(Escaped(Utf8(text), '&', "&amp;"), '<', "&lt;");
  return Escaped(Escaped(Escaped(escaped, '>', "&gt;"), '"', "&quot;"), '\'', "&#39;");
}

std::string Faint(const std::string& text) {
  return fmt::format("<p class=\"faint\">{}</p>\n", HtmlText(text));
}

std::string Section(const std::string& id, const std::string& title, const std::string& content) {
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", HtmlText(id),
                     HtmlText(title), content);
}

std::string HtmlTable(const Table& table, const std::vector<size_t>& indices) {
  std::string html = fmt::format("<div class=\"scroll {}\"><table>\n<thead><tr>", table.name);
  for (const std::string& name : table.header) html += fmt::format("<th>{}</th>", HtmlText(name));
  html += "</tr></thead>\n<tbody>\n";
  for (size_t i = 0; i < table.rows.size(); ++i) {
    html += indices.empty() ? "<tr>" : fmt::format("<tr data-index=\"{}\">", indices[i]);
    for (const Cell& cell : table.rows[i]) {
      html += fmt::format("<td{}>{}</td>", cell.bold ? " class=\"best\"" : "", HtmlText(cell.text));
    }
    html += "</tr>\n";
  }
  return html + "</tbody>\n</table></div>\n";
}

std::string PageHtml(const std::string& title, const std::string& content, const json& data,
                     PageScripts scripts) {
  const auto& files = EmbeddedPageFiles();
  std::string script_elements, licences;
  if (scripts == PageScripts::kDataset) {
    // Libraries first; of our files, those with functions that others use.
    for (const char* name : {"three.min.js", "OrbitControls.js", "chart.min.js", "elements.js",
                             "overlay.js", "charts.js", "yaw_curves.js", "bodies.js", "map.js",
                             "figures.js", "objects.js", "frames.js", "main.js"}) {
      script_elements += fmt::format("<script>\n{}\n</script>\n", files.at(name));
    }
    licences = Filled(files.at("licences.html"),
                      {{"third_party", HtmlText(std::string(files.at("THIRD_PARTY.md")))}});
  }
  return Filled(files.at("page.html"), {{"title", HtmlText(title)},
                                        {"style", std::string(files.at("page.css"))},
                                        {"content", content},
                                        {"licences", licences},
                                        {"data", PageText(data)},
                                        {"scripts", script_elements}});
}

namespace {

namespace fs = std::filesystem;

// Artefacts in the order in which stages write them.
constexpr std::array kArtefacts = {"sequence.json", "world.json",   "associations.json",
                                   "planes.json",   "initial.json", "refined.json",
                                   "map.json",      "metrics.json"};

// Empty for a file that cannot be read; the page lists such files elsewhere. Damaged findings are a
// finding.
std::vector<Finding> FindingsIn(const fs::path& file) {
  json document;
  try {
    document = ParseJsonFile(file);
  } catch (const InputError&) {
  }
  if (!document.is_object()) return {};
  try {
    return ReadFindings(document);
  } catch (const InputError& error) {
    return {{"findings", Severity::kWarning, error.what(), "findings as its stage writes them",
             "a file that was edited, or written by another version",
             "run the stage that made it again"}};
  }
}

}  // namespace

std::vector<PageFinding> PageFindings(const DatasetResult& dataset) {
  std::map<fs::path, std::vector<Finding>> findings_of;  // by resolved path
  std::vector<PageFinding> findings;
  for (const char* artefact : kArtefacts) {
    nlohmann::ordered_map<Finding, std::vector<std::string>> found;  // with the variants' names
    for (const VariantResult& variant : dataset.variants) {
      const fs::path file = fs::weakly_canonical(variant.folder / artefact);
      if (!findings_of.contains(file)) findings_of[file] = FindingsIn(file);
      for (const Finding& finding : findings_of[file]) found[finding].push_back(variant.name);
    }
    for (const auto& [finding, variants] : found) {
      const bool in_all = variants.size() == dataset.variants.size();
      findings.push_back(
          {finding,
           fmt::format("{} of {}", artefact,
                       in_all ? "all variants" : fmt::to_string(fmt::join(variants, ", ")))});
    }
  }
  std::stable_partition(findings.begin(), findings.end(), [](const PageFinding& of) {
    return of.finding.severity == Severity::kError;
  });
  return findings;
}

std::string FindingsHtml(const std::vector<PageFinding>& findings) {
  if (findings.empty()) return "";
  std::string items;
  for (const auto& [finding, where] : findings) {
    items += fmt::format(
        "<li class=\"{0}\"><strong>{0}: {1}</strong> <span class=\"faint\">({2}, "
        "{3})</span><br>expected: {4}<br>likely cause: {5}<br>remedy: {6}</li>\n",
        NameOf(finding.severity), HtmlText(finding.found), HtmlText(finding.check), HtmlText(where),
        HtmlText(finding.expected), HtmlText(finding.cause), HtmlText(finding.remedy));
  }
  return "<h3>Findings</h3>\n<ul class=\"findings\">\n" + items + "</ul>\n";
}

}  // namespace soslam
