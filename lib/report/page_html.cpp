// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_html.h"

#include <fmt/format.h>

#include <cctype>
#include <stdexcept>

namespace soslam {
namespace {

using nlohmann::json;

void Replace(const std::string& placeholder, std::string_view by, std::string* text) {
  const size_t at = text->find(placeholder);
  if (at == std::string::npos) throw std::logic_error("page.html has no " + placeholder);
  text->replace(at, placeholder.size(), by);
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
  return Escaped(Dump(data), '<', "\\u003c");  // it would begin or end elements
}

std::string PageHtml(const std::string& title, const std::string& entry, const json& data) {
  const auto& files = EmbeddedPageFiles();
  std::string scripts;
  // Libraries first; of ours the functions that others use.
  for (const char* name :
       {"three.min.js", "OrbitControls.js", "chart.min.js", "elements.js", "overlay.js",
        "charts.js", "yaw_curves.js", "above.js", "bodies.js", "map.js", "figures.js", "objects.js",
        "frames.js", "tables.js", "main.js"}) {
    scripts += fmt::format("<script>\n{}\n</script>\n", files.at(name));
  }
  std::string html(files.at("page.html"));
  Replace("{{title}}", Escaped(Escaped(Utf8(title), '&', "&amp;"), '<', "&lt;"), &html);
  Replace("{{style}}", files.at("page.css"), &html);
  Replace("{{scripts}}", scripts, &html);
  Replace("{{entry}}", entry, &html);
  Replace("{{data}}", PageText(data), &html);
  return html;
}

}  // namespace soslam
