// SPDX-License-Identifier: BSD-3-Clause
#include "cli/help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "base/text.h"

namespace soslam::internal {
namespace {

constexpr size_t kTextColumn = 34;
constexpr size_t kWidth = 100;

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
  return Wrapped(app->get_description(), kWidth) + "\n";
}

// Replaces CLI11's two empty lines between groups by one.
std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  const std::string help = CLI::Formatter::make_help(app, std::move(name), mode);
  return ReplaceAll(help, "\n\n\n", "\n\n");
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  return Wrapped(option->get_description(), kWidth - kTextColumn);
}

std::string OptionHelp(const OptionRow& row) {
  const std::string domain = Domain(row);
  const std::string value =
      row.choices.empty() ? row.default_value.dump() : row.default_value.get<std::string>();
  return fmt::format("{}\n[default {}{}{}]", row.doc, value, domain.empty() ? "" : "; ", domain);
}

std::string ExampleHelp(const std::string& command) {
  return ReplaceAll(Wrapped(command, kWidth - 8), "\n", " \\\n      ");
}

}  // namespace soslam::internal
