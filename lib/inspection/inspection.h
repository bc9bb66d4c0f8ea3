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

// A statement about an artefact in words.
struct Fact {
  std::string name;  // "trajectory"
  std::string text;
};

// A readable summary of an artefact.
struct Inspection {
  std::string title;  // file, kind and description
  std::vector<Fact> facts;
  ValueTable table;
};

// Reads an artefact of any kind. `sequence`, if known, supplies the labels of objects. Throws
// InputError for a file that is no artefact, of an unknown kind, newer than this software or
// damaged.
Inspection Inspect(const std::filesystem::path& file, const std::optional<Sequence>& sequence);

// Text for a terminal: title, facts, table. `is_coloured`: with escape sequences.
std::string FormatInspection(const Inspection& inspection, bool is_coloured);

// "3 near_border, 2 duplicate", the most frequent first; "none" when there are none.
std::string CountsInWords(const std::map<std::string, int>& counts);

}  // namespace soslam
