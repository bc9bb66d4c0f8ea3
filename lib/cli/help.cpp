// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>
#include <utility>

namespace soslam::internal {
namespace {

constexpr size_t kTextColumn = 34;
constexpr size_t kWidth = 100;

// Wraps lines at spaces to at most `width` characters, except for longer words.
std::string Wrap(const std::string& text, size_t width) {
  std::string wrapped;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!wrapped.empty()) wrapped += '\n';
    std::istringstream words(line);
    size_t length = 0;
    for (std::string word; words >> word;) {
      const bool fits = length + 1 + word.size() <= width;
      if (length > 0) wrapped += fits ? ' ' : '\n';
      length = length > 0 && fits ? length + 1 + word.size() : word.size();
      wrapped += word;
    }
  }
  return wrapped;
}

std::string ReplaceAll(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// Possible values of an option; empty when all of its type.
std::string Domain(const OptionRow& row) {
  if (row.range) {
    return fmt::format("{} to {}{}{}", row.range->min, row.range->max, row.unit.empty() ? "" : " ",
                       row.unit);
  }
  if (row.type == "boolean") return "true | false";
  return fmt::format("{}", fmt::join(row.choices, " | "));
}

}  // namespace

HelpFormatter::HelpFormatter() { column_width(kTextColumn); }

std::string HelpFormatter::make_description(const CLI::App* app) const {
  return Wrap(app->get_description(), kWidth) + "\n";
}

// Replaces CLI11's two empty lines between groups by one.
std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  const std::string help = CLI::Formatter::make_help(app, std::move(name), mode);
  return ReplaceAll(help, "\n\n\n", "\n\n");
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  return Wrap(option->get_description(), kWidth - kTextColumn);
}

std::string OptionHelp(const OptionRow& row) {
  const std::string domain = Domain(row);
  const std::string value =
      row.choices.empty() ? row.default_value.dump() : row.default_value.get<std::string>();
  return fmt::format("{}\n[default {}{}{}]", row.doc, value, domain.empty() ? "" : "; ", domain);
}

std::string ExampleHelp(const std::string& command) {
  return ReplaceAll(Wrap(command, kWidth - 8), "\n", " \\\n      ");
}

}  // namespace soslam::internal
