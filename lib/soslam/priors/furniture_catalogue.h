// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "soslam/base/description.h"

namespace soslam {

// A model of a furniture catalogue. Half axes along x (front), y and z (up), metres.
struct CatalogueModel {
  std::string name;
  std::string category;
  Eigen::Vector3d half_axes;
};

// The models in a CSV file with a header that has columns name, category, depth_m, width_m and
// height_m (others are ignored); fields with commas in double quotes. Throws InputError, naming
// file, line and field.
std::vector<CatalogueModel> ReadFurnitureCatalogue(const std::filesystem::path& path);

// The models that have a label: those with a name, in one category or in any.
struct CatalogueName {
  std::string name;
  std::string category;  // empty for any
};
using CatalogueNames = std::map<std::string, std::vector<CatalogueName>>;  // by label

// The file that says which models of a catalogue count as which label of the semantic table.
struct CatalogueLabels {
  std::string description;
  CatalogueNames labels;
};
template <typename Visitor>
void Describe(Visitor& visit, CatalogueName& name) {
  if (visit.IsText(&name.name, "name of models, whatever its case, in any category")) return;
  visit.Field("name", &name.name, "name of models", kNotEmpty);
  visit.Field("category", &name.category, "their category", kNotEmpty);
}
template <typename Visitor>
void Describe(Visitor& visit, CatalogueLabels& file) {
  visit.OrAbsent("description", &file.description, "for readers of the file");
  visit.Field("labels", &file.labels,
              "by label or alias of the semantic table; a model may count as several");
}

// Reads such a file. Throws InputError.
CatalogueNames ReadCatalogueNames(const std::filesystem::path& path);

// True if a model has one of the names, whatever their case.
bool GoesBy(const CatalogueModel& model, const std::vector<CatalogueName>& names);

}  // namespace soslam
