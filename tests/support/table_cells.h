// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "base/table.h"

namespace soslam {

// The rows of a table, each with its cells divided by blanks and bold ones between stars.
inline std::vector<std::string> CellTexts(const Table& table) {
  std::vector<std::string> lines;
  for (const auto& row : table.rows) {
    std::string line;
    for (const Cell& cell : row) {
      line += (line.empty() ? "" : " ") + (cell.bold ? "*" + cell.text + "*" : cell.text);
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace soslam
