// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "inspection/value_table.h"
#include "model/sequence.h"

namespace soslam {

// One thing that is said about an artefact in words.
struct Fact {
  std::string name;  // "trajectory"
  std::string text;
};

// An artefact as a person reads it.
struct Inspection {
  std::string title;  // what it is
  std::vector<Fact> facts;
  ValueTable table;
};

// Reads an artefact of any kind. `sequence`, where it is known, gives objects their labels. Throws
// InputError for what is no artefact, of an unknown kind, newer than this software or damaged.
Inspection Inspect(const std::filesystem::path& file, const std::optional<Sequence>& sequence);

// For a terminal: title, facts, table. `is_coloured`: with escape sequences.
std::string FormatInspection(const Inspection& inspection, bool is_coloured);

// "3 near_border, 2 duplicate", the most frequent first; "none" when there are none.
std::string CountsInWords(const std::map<std::string, int>& counts);

}  // namespace soslam
