// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_html.h"

#include <fmt/format.h>

#include <cctype>

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
  for (const char c : text) {
    if (c == what) {
      escaped += by;
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string Dump(const json& data) {
  return data.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

std::string Utf8(const std::string& bytes) { return json::parse(Dump(bytes)).get<std::string>(); }

std::string UrlOf(const std::string& name) {
  std::string url;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = byte < 0x80 && (std::isalnum(byte) != 0 || c == '-' || c == '_');
    url += is_plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return url;
}

std::string PageText(const json& data) {
  return Escaped(Dump(data), '<', "\\u003c");  // '<' would begin or end elements
}

std::string HtmlText(const std::string& text) {
  std::string escaped = Escaped(Escaped(Utf8(text), '&', "&amp;"), '<', "&lt;");
  return Escaped(Escaped(Escaped(escaped, '>', "&gt;"), '"', "&quot;"), '\'', "&#39;");
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
                             "overlay.js", "charts.js", "yaw_curves.js", "above.js", "bodies.js",
                             "map.js", "figures.js", "objects.js", "frames.js", "main.js"}) {
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

}  // namespace soslam
