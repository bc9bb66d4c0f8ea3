// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/priors/furniture_catalogue.h"

#include <fmt/format.h>

#include <algorithm>

#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/base/text.h"
#include "soslam/dataset/text_file.h"

namespace soslam {
namespace {

double HalfAxis(const CsvRow& row, const char* column) {
  const double length_m = row.Real(column);
  if (!(length_m > 0.0)) {
    throw InputError(
        fmt::format("{}: {} is {}; expected metres > 0", row.place, column, row.fields.at(column)));
  }
  return 0.5 * length_m;
}

}  // namespace

std::vector<CatalogueModel> ReadFurnitureCatalogue(const std::filesystem::path& path) {
  std::vector<CatalogueModel> models;
  const CsvColumns columns{{"name", "category", "depth_m", "width_m", "height_m"}, {}};
  ForEachCsvRow(path, columns, [&](const CsvRow& row) {
    models.push_back(
        {row.fields.at("name"),
         row.fields.at("category"),
         {HalfAxis(row, "depth_m"), HalfAxis(row, "width_m"), HalfAxis(row, "height_m")}});
  });
  return models;
}

CatalogueNames ReadCatalogueNames(const std::filesystem::path& path) {
  return ReadDocument<CatalogueLabels>(ParseJsonFile(path), path.string()).labels;
}

bool GoesBy(const CatalogueModel& model, const std::vector<CatalogueName>& names) {
  return std::ranges::any_of(names, [&](const CatalogueName& name) {
    return LowerCase(name.name) == LowerCase(model.name) &&
           (name.category.empty() || LowerCase(name.category) == LowerCase(model.category));
  });
}

}  // namespace soslam
