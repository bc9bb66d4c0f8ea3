// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// A cell of a table of values: a number, a text, a truth value, or null for no value.
using Value = nlohmann::json;

struct ValueColumn {
  std::string name;
  std::string unit = {};   // "m", "deg", "px", "%"; empty without one
  int decimals = 2;        // of numbers that are not whole, in text for people
  std::string field = {};  // of the JSON objects of TableOf, "errors/iou"; empty: the name
};

// Rows have one cell per column.
struct ValueTable {
  std::vector<ValueColumn> columns;
  std::vector<std::vector<Value>> rows;
};

// The table with a row for each of these JSON objects; fields that are absent have no value.
ValueTable TableOf(const std::vector<ValueColumn>& columns, const nlohmann::json& objects);

// Text for a terminal: a line of names, one of units, and the rows, in aligned columns; columns
// without any value are left out. `is_coloured`: with escape sequences.
std::string FormatTable(const ValueTable& table, bool is_coloured);

// RFC 4180 with lines that end in a line feed: the names of all columns, with their units
// ("yaw_deg"), then the rows. Numbers round-trip exactly.
std::string FormatCsv(const ValueTable& table);

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

// Number of rows for each value of a field, except empty ones.
std::map<std::string, int> CountsBy(const char* field, const nlohmann::json& rows);

// The text with each "{field}" replaced by that field of a JSON object, "-" if it is null. Fields
// of parts are "part/field"; a number may have a format, "{field:.3f}". Throws json::exception for
// a field that is missing.
std::string FillIn(std::string_view text, const nlohmann::json& fields);

// Contents of an artefact of each kind, by its file or document; Inspect adds title, provenance and
// labels of objects. Errors as there; json::exception for a field that is missing.
Inspection InspectAssociations(const nlohmann::json& document);
Inspection InspectEdges(const std::filesystem::path& file);
Inspection InspectFrames(const nlohmann::json& document);
Inspection InspectLandmarks(const nlohmann::json& document);
Inspection InspectMap(const nlohmann::json& document);
Inspection InspectMetrics(const nlohmann::json& document);
Inspection InspectPlanes(const nlohmann::json& document);
Inspection InspectPoints(const std::filesystem::path& file);
Inspection InspectReconstruction(const std::filesystem::path& file);
Inspection InspectSemanticTable(const std::filesystem::path& file);
Inspection InspectSequence(const std::filesystem::path& file);
Inspection InspectSymmetry(const std::filesystem::path& file);
Inspection InspectWorld(const std::filesystem::path& file);

}  // namespace soslam
