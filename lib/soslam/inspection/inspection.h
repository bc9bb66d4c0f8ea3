// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "soslam/artefact/hdf5_file.h"
#include "soslam/model/sequence.h"

namespace soslam {

// A value as a file has it; null for no value.
using Value = nlohmann::json;

struct ValueColumn {
  std::string name;  // JSON pointer in a row, without the first slash: "errors/iou"
  std::string doc = {};
};

// Rows have one cell per column.
struct ValueTable {
  std::vector<ValueColumn> columns;
  std::vector<std::vector<Value>> rows;
  std::string name = {};  // path in the file: "map_quality/landmarks"
  std::string doc = {};
};

// A value in words: of lists at most six items, of lists of records their number. Numbers have four
// digits where they are as large as `largest`.
std::string InWords(const Value& value, double largest);
std::string InWords(const Value& value);

// The rows that are printed, and the width of a line; wider tables are printed in parts, each with
// the first two columns.
struct TableLimits {
  size_t rows = std::numeric_limits<size_t>::max();
  size_t width = std::numeric_limits<size_t>::max();
};

// Text for a terminal: names and rows in aligned columns; columns without any value are left out.
// `is_coloured`: with escape sequences.
std::string FormatTable(const ValueTable& table, bool is_coloured, const TableLimits& limits = {});

// RFC 4180 with lines that end in a line feed: the names of all columns, then the rows. Numbers
// round-trip exactly. A column of vectors becomes one for each number, "half_axes/0".
std::string FormatCsv(const ValueTable& table);

// A statement about an artefact.
struct Fact {
  std::string name;  // "trajectory", or the path of a field: "solver/final_cost"
  std::string text;
  std::string doc = {};  // what a field is
};

// An artefact's contents in words and tables, for a person.
struct Inspection {
  std::string title;  // file, kind and what that holds
  std::vector<Fact> facts;
  std::vector<ValueTable> tables;
};

// Reads an artefact of any kind. `sequence`, if known, supplies the labels of objects; settings
// with their default values are not listed. Throws InputError for a file that is no artefact, of an
// unknown kind, newer than this software or damaged.
Inspection Inspect(const std::filesystem::path& file, const std::optional<Sequence>& sequence,
                   const nlohmann::json& default_settings = nlohmann::json::object());

// Leaves of all tables the rows of the object with this id. Throws SettingsError if there is none.
void KeepObject(int id, Inspection* inspection);

// Text for a terminal: title, facts, and the first rows of each table. `is_coloured`: with escape
// sequences.
std::string FormatInspection(const Inspection& inspection, bool is_coloured);

// The table of this name, or the first one. Throws SettingsError, naming the known ones.
const ValueTable& FindTable(const Inspection& inspection, const std::optional<std::string>& name);

// Text for a terminal: all rows, and what the columns are.
std::string FormatWholeTable(const ValueTable& table, bool is_coloured);

// The contents of a document by the JSON schema of its kind, which follows from its description:
// lists of records are tables, whose rows have the fields of a record and, of a list in it, the
// number of items and the fields of the first one; all other fields are facts.
Inspection InspectContents(const nlohmann::ordered_json& schema, const nlohmann::json& document);

// The contents of an HDF5 file: groups in a group of the root are rows of a table, and have
// attributes and data sets; data sets of the root are facts. Throws InputError.
Inspection InspectContents(const Hdf5File& file);

}  // namespace soslam
