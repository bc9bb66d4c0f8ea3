// SPDX-License-Identifier: BSD-3-Clause
#include "priors/furniture_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "artefact/json_file.h"
#include "base/error.h"
#include "base/text.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

constexpr std::array kColumns = {"name", "category", "depth_m", "width_m", "height_m"};

// The fields of a line of CSV; quotes around a field are dropped, doubled quotes in it are one.
std::vector<std::string> CsvFields(const TextLine& line) {
  std::vector<std::string> fields(1);
  bool is_quoted = false;
  for (size_t i = 0; i < line.text.size(); ++i) {
    const char character = line.text[i];
    if (character == '"' && is_quoted && i + 1 < line.text.size() && line.text[i + 1] == '"') {
      fields.back() += line.text[++i];
    } else if (character == '"') {
      is_quoted = !is_quoted;
    } else if (character == ',' && !is_quoted) {
      fields.emplace_back();
    } else {
      fields.back() += character;
    }
  }
  if (is_quoted) throw InputError(line.place + ": a double quote is open; expected it closed");
  for (std::string& field : fields) field = Trimmed(field);
  return fields;
}

std::array<size_t, kColumns.size()> ColumnPositions(const TextLine& header) {
  const std::vector<std::string> fields = CsvFields(header);
  std::array<size_t, kColumns.size()> positions{};
  for (size_t i = 0; i < kColumns.size(); ++i) {
    if (std::count(fields.begin(), fields.end(), kColumns[i]) != 1) {
      throw InputError(fmt::format(
          "{}: has column '{}' {} times; expected each of {} once", header.place, kColumns[i],
          std::count(fields.begin(), fields.end(), kColumns[i]), fmt::join(kColumns, ",")));
    }
    positions[i] =
        static_cast<size_t>(std::find(fields.begin(), fields.end(), kColumns[i]) - fields.begin());
  }
  return positions;
}

double HalfAxis(const std::string& text, const std::string& place, const char* column) {
  const double length_m = ParseReal(text, place, column);
  if (!(length_m > 0.0)) {
    throw InputError(fmt::format("{}: {} is {}; expected metres > 0", place, column, text));
  }
  return 0.5 * length_m;
}

bool SameText(const std::string& one, const std::string& other) {
  return LowerCase(one) == LowerCase(other);
}

CatalogueName NameFromJson(const nlohmann::json& json) {
  if (json.is_string()) return {json.get<std::string>(), ""};
  return {json.at("name").get<std::string>(), json.at("category").get<std::string>()};
}

}  // namespace

std::vector<CatalogueModel> ReadFurnitureCatalogue(const std::filesystem::path& path) {
  const std::vector<TextLine> lines = ReadTextLines(path);
  if (lines.empty()) {
    throw InputError(
        fmt::format("{}: is empty; expected a header {}", path.string(), fmt::join(kColumns, ",")));
  }
  const auto positions = ColumnPositions(lines[0]);
  const size_t columns = CsvFields(lines[0]).size();
  std::vector<CatalogueModel> models;
  for (size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> fields = CsvFields(lines[i]);
    const std::string& place = lines[i].place;
    if (fields.size() != columns) {
      throw InputError(fmt::format("{}: has {} fields; expected {}, as the header has", place,
                                   fields.size(), columns));
    }
    const auto half_axis = [&](size_t k) {
      return HalfAxis(fields[positions[k]], place, kColumns[k]);
    };
    models.push_back(
        {fields[positions[0]], fields[positions[1]], {half_axis(2), half_axis(3), half_axis(4)}});
  }
  return models;
}

CatalogueNames ReadCatalogueNames(const std::filesystem::path& path) {
  const nlohmann::json document = ParseJsonFile(path);
  ValidateAgainstSchema(document, "furniture_labels", path.string());
  CatalogueNames names;
  for (const auto& label : document.at("labels").items()) {
    for (const auto& name : label.value()) names[label.key()].push_back(NameFromJson(name));
  }
  return names;
}

bool GoesBy(const CatalogueModel& model, const std::vector<CatalogueName>& names) {
  return std::any_of(names.begin(), names.end(), [&](const CatalogueName& name) {
    return SameText(name.name, model.name) &&
           (name.category.empty() || SameText(name.category, model.category));
  });
}

}  // namespace soslam
