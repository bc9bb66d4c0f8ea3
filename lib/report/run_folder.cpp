// SPDX-License-Identifier: BSD-3-Clause
#include "report/run_folder.h"

#include <fmt/format.h>

#include <fstream>

#include "base/error.h"
#include "base/run_log.h"

namespace soslam {

namespace fs = std::filesystem;

std::vector<std::string> RunsIn(const fs::path& list) {
  constexpr size_t kMaxName = 255;  // bytes; limit of names on Linux
  RecordInput(list);
  std::vector<std::string> runs;
  std::ifstream lines(list);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    if (line.size() > kMaxName || fs::path(line).filename() != line || line == "..") {
      throw InputError(
          fmt::format("{}: run is '{}'; expected the name of a folder", list.string(), line));
    }
    runs.push_back(line);
  }
  return runs;
}

std::string StageOf(const std::string& run) { return run.substr(0, run.rfind('-')); }

std::string FailureIn(const fs::path& run_folder) {
  std::ifstream stream(run_folder / "failed");
  std::string line;
  std::getline(stream, line);
  return line;
}

}  // namespace soslam
