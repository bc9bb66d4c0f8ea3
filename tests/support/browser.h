// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/run_command.h"
#include "support/temporary_folder.h"

namespace soslam {

inline bool HasBrowser() { return RunCommand({"which", "chromium"}).exit_code == 0; }

// What tests/support/page_check.js finds on a page in a browser without a screen; null when the
// browser did not come that far.
inline nlohmann::json CheckPage(const std::filesystem::path& page) {
  const TemporaryFolder folder;
  std::string html = FileBytes(page);
  const std::string watch =
      "<script>window.errorsOfPage = [];"
      "addEventListener(\"error\", (event) => errorsOfPage.push(event.message));"
      "console.error = console.warn = (...words) => errorsOfPage.push(words.join(\" \"));"
      "</script>\n<main";
  html.replace(html.find("<main"), 5, watch);
  const std::string check = FileBytes(SOSLAM_SOURCE_DIR "/tests/support/page_check.js");
  const std::string end = "</body>";
  html.insert(html.rfind(end), "<script>" + check + "</script>\n");
  WriteBytes(folder / "page.html", html);
  const CommandResult shown = RunCommand(
      {"timeout", "120", "chromium", "--headless", "--no-sandbox", "--use-angle=swiftshader",
       "--enable-unsafe-swiftshader", "--window-size=1280,900", "--virtual-time-budget=20000",
       "--user-data-dir=" + (folder / "profile").string(), "--dump-dom",
       "file://" + (folder / "page.html").string()});
  const size_t begin = shown.output.rfind("CHECK{");
  const size_t close = shown.output.rfind("}KCEHC");
  if (begin == std::string::npos || close == std::string::npos) return {};
  return nlohmann::json::parse(shown.output.substr(begin + 5, close + 1 - begin - 5));
}

}  // namespace soslam
