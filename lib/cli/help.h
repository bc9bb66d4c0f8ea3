// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "base/options.h"

namespace soslam::internal {

// Layout of --help: names in one column, wrapped texts in another.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_option_desc(const CLI::Option* option) const override;
};

// Help text of an option: its doc, default, and range or choices, with units.
std::string OptionHelp(const OptionRow& row);

// A command wrapped over several lines such that a shell reads it as one.
std::string ExampleHelp(const std::string& command);

}  // namespace soslam::internal
