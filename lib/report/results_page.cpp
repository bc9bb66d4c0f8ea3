// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <sstream>
#include <string_view>

#include "base/error.h"
#include "base/hash.h"
#include "report/tables.h"

namespace soslam {
namespace {

constexpr std::string_view kBegin = "<!-- table: ";
constexpr std::string_view kEnd = "<!-- end";
constexpr std::string_view kClose = " -->";

// A table in a page: its name, the lines between its markers, and the line that ends it.
struct PageTable {
  std::string name;
  std::string content;
  std::string end;
};

std::string EndOf(const std::string& content) {
  return fmt::format("{}: {}{}", kEnd, Sha256OfText(content), kClose);
}

std::string NameIn(const std::string& line) {
  const size_t close = line.find(kClose, kBegin.size());
  return line.substr(kBegin.size(), close == line.npos ? line.npos : close - kBegin.size());
}

// The page with each table replaced by what `replace` returns: its content and its last line.
std::string ReplaceTables(const std::string& page, const std::string& name,
                          const std::function<std::string(const PageTable&)>& replace) {
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
    PageTable table = {NameIn(line), "", ""};
    const int first = number;
    while (table.end.empty()) {
      if (!std::getline(lines, line) || line.starts_with(kBegin)) {
        throw InputError(
            fmt::format("{}:{}: table '{}' has no end; expected a line '{}{}' after it", name,
                        first, table.name, kEnd, kClose));
      }
      ++number;
      if (line.starts_with(kEnd)) {
        table.end = line;
      } else {
        table.content += line + "\n";
      }
    }
    text += replace(table);
  }
  return text;
}

}  // namespace

std::string FillPage(const std::string& page, const std::vector<Table>& tables,
                     const std::string& name) {
  return ReplaceTables(page, name, [&](const PageTable& old) {
    const auto table = std::ranges::find(tables, old.name, &Table::name);
    if (table == tables.end()) {
      std::vector<std::string> names;
      for (const Table& known : tables) names.push_back(known.name);
      throw InputError(fmt::format("{}: no table '{}' in these results; there are {}", name,
                                   old.name, fmt::join(names, ", ")));
    }
    const std::string content = "\n#" + ToMarkdown(*table) + "\n";  // a third-level heading
    return content + EndOf(content) + "\n";
  });
}

std::vector<std::string> EditedTables(const std::string& page, const std::string& name) {
  std::vector<std::string> edited;
  ReplaceTables(page, name, [&](const PageTable& table) {
    if (table.end != EndOf(table.content)) edited.push_back(table.name);
    return table.content;
  });
  return edited;
}

}  // namespace soslam
