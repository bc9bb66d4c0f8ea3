// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/inspection/inspection.h"

namespace soslam {
namespace {

using nlohmann::json;
using Schema = nlohmann::ordered_json;

// The schema of the rows of a table: of the records, or rows of numbers, in a list or map. Null for
// other values.
const Schema* FindRows(const Schema& schema) {
  for (const char* part : {"items", "additionalProperties"}) {
    if (!schema.contains(part) || !schema[part].is_object()) continue;
    const Schema& row = schema[part];
    if (row.contains("properties") || (row.contains("items") && row["items"].is_array())) {
      return &row;
    }
  }
  return nullptr;
}

std::string DocOf(const Schema& field) { return field.value("description", ""); }

void AddColumns(const Schema& row, const std::string& place, std::vector<ValueColumn>* columns) {
  for (const auto& [name, field] :
       row[row.contains("properties") ? "properties" : "items"].items()) {
    if (field.contains("properties")) {
      AddColumns(field, place + name + "/", columns);
      continue;
    }
    columns->push_back({place + name, DocOf(field)});
    const Schema* of_list = field.contains("items") ? FindRows(field) : nullptr;
    if (of_list != nullptr && of_list->contains("properties")) {
      AddColumns(*of_list, place + name + "/0/", columns);
    }
  }
}

// Rows of a map begin with their names.
ValueTable MakeTable(const std::string& name, const Schema& field, const json& rows) {
  ValueTable table{{}, {}, name, DocOf(field)};
  AddColumns(*FindRows(field), "", &table.columns);
  for (const auto& [key, item] : rows.items()) {
    std::vector<Value>& row = table.rows.emplace_back();
    if (rows.is_object()) row.emplace_back(key);
    for (const ValueColumn& column : table.columns) {
      const json::json_pointer place("/" + column.name);
      row.push_back(item.contains(place) ? item[place] : Value());
    }
  }
  if (rows.is_object()) table.columns.insert(table.columns.begin(), {"name"});
  return table;
}

void AddRecord(const Schema& schema, const json& record, const std::string& place,
               Inspection* contents) {
  for (const auto& [name, field] : schema["properties"].items()) {
    if (!record.contains(name)) continue;
    const json& value = record[name];
    if (field.contains("properties") && !value.is_null()) {
      AddRecord(field, value, place + name + "/", contents);
    } else if (FindRows(field) != nullptr && !value.is_null()) {
      contents->tables.push_back(MakeTable(place + name, field, value));
    } else {
      contents->facts.push_back({place + name, InWords(value), DocOf(field)});
    }
  }
}

// "480 x 640, 0 to 120.4, mean 24.9": size and finite values of a data set.
std::string SummariseNumbers(const Hdf5File::Numbers& numbers) {
  std::string text = fmt::format("{}", fmt::join(numbers.shape, " x "));
  std::vector<double> finite;
  std::ranges::copy_if(numbers.values, std::back_inserter(finite),
                       [](double value) { return std::isfinite(value); });
  if (finite.empty()) return text;
  const auto [least, largest] = std::ranges::minmax(finite);
  const double mean =
      std::accumulate(finite.begin(), finite.end(), 0.0) / static_cast<double>(finite.size());
  return text + fmt::format(", {:.4g} to {:.4g}, mean {:.4g}", least, largest, mean);
}

// Attributes and data sets of a group and of those in it.
Schema ReadRecord(const Hdf5File& file, const std::string& group) {
  Schema record;
  for (const std::string& name : file.Attributes(group)) {
    const double number = file.ReadNumber(group, name);
    const bool is_whole = number == std::round(number) && std::abs(number) < 1e15;
    record[name] = is_whole ? Schema(std::llround(number)) : Schema(number);
  }
  for (const std::string& name : file.Children(group)) {
    const std::string place = group + "/" + name;
    record[name] = file.IsGroup(place) ? ReadRecord(file, place)
                                       : Schema(SummariseNumbers(file.ReadNumbers(place)));
  }
  return record;
}

ValueTable MakeTable(const Hdf5File& file, const std::string& group) {
  ValueTable table{{{"name"}}, {}, group.substr(1)};
  std::vector<Schema> records;
  for (const std::string& name : file.Children(group)) {
    records.push_back(ReadRecord(file, group + "/" + name).flatten());
    table.rows.push_back({name});
    for (const auto& item : records.back().items()) {
      if (item.value().is_null()) continue;
      const std::string column = item.key().substr(1);
      if (std::ranges::find(table.columns, column, &ValueColumn::name) == table.columns.end()) {
        table.columns.push_back({column});
      }
    }
  }
  for (size_t i = 0; i < records.size(); ++i) {
    for (size_t k = 1; k < table.columns.size(); ++k) {
      table.rows[i].push_back(records[i].value("/" + table.columns[k].name, Value()));
    }
  }
  return table;
}

}  // namespace

Inspection InspectContents(const Schema& schema, const json& document) {
  // The header and the findings are told in words.
  Schema of_body = schema;
  for (const char* name : {"artefact", "findings"}) of_body["properties"].erase(name);
  Inspection contents;
  AddRecord(of_body, document, "", &contents);
  return contents;
}

Inspection InspectContents(const Hdf5File& file) {
  file.RequireWalkable();
  Inspection contents;
  for (const std::string& name : file.Attributes("/")) {
    if (name == kHeaderAttribute) continue;
    contents.facts.push_back({name, file.IsText("/", name)
                                        ? file.ReadText("/", name)
                                        : fmt::format("{}", file.ReadNumber("/", name))});
  }
  for (const std::string& name : file.Children("/")) {
    const std::string place = "/" + name;
    if (!file.IsGroup(place)) {
      contents.facts.push_back({name, SummariseNumbers(file.ReadNumbers(place))});
      continue;
    }
    const auto children = file.Children(place);
    if (std::ranges::all_of(children, [&](const std::string& child) {
          return file.IsGroup(place + "/" + child);
        })) {
      contents.tables.push_back(MakeTable(file, place));
      continue;
    }
    for (const std::string& child : children) {
      contents.facts.push_back(
          {name + "/" + child, SummariseNumbers(file.ReadNumbers(place + "/" + child))});
    }
  }
  return contents;
}

}  // namespace soslam
