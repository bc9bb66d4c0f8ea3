// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "soslam/base/error.h"
#include "soslam/report/tables.h"
#include "soslam/system/hash.h"

namespace soslam {
namespace {

constexpr std::string_view kBegin = "<!-- table: ";
constexpr std::string_view kEnd = "<!-- end";
constexpr std::string_view kClose = " -->";

}  // namespace

std::string FillPage(const std::string& page, const std::vector<Table>& tables,
                     const std::string& name) {
  std::istringstream lines(page);
  std::string text;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with(kEnd)) {
      throw InputError(
          fmt::format("{}:{}: end of a table that does not begin; expected '{}NAME{}' before it",
                      name, number, kBegin, kClose));
    }
    text += line + "\n";
    if (!line.starts_with(kBegin)) continue;
    const size_t close = line.find(kClose, kBegin.size());
    const std::string wanted =
        line.substr(kBegin.size(), close == line.npos ? line.npos : close - kBegin.size());
    const int first = number;
    while (!line.starts_with(kEnd)) {
      if (!std::getline(lines, line) || line.starts_with(kBegin)) {
        throw InputError(
            fmt::format("{}:{}: table '{}' has no end; expected a line '{}{}' after it", name,
                        first, wanted, kEnd, kClose));
      }
      ++number;
    }
    const auto table = std::ranges::find(tables, wanted, &Table::name);
    if (table == tables.end()) {
      std::vector<std::string> names;
      for (const Table& known : tables) names.push_back(known.name);
      throw InputError(fmt::format("{}: no table '{}' in these results; there are {}", name, wanted,
                                   fmt::join(names, ", ")));
    }
    const std::string content = "\n#" + ToMarkdown(*table) + "\n";  // a third-level heading
    text += fmt::format("{}{}: {}{}\n", content, kEnd, Sha256OfText(content), kClose);
  }
  return text;
}

}  // namespace soslam
