// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "initialisation/semantic_table.h"
#include "model/sequence.h"
#include "priors/furniture_catalogue.h"
#include "priors/options.h"

namespace soslam {

// The data of one source for a label: half axes along x (front), y and z (up) of the upright
// object, in metres, one per object; shape exponents of the objects whose boxes determine it.
struct LabelFacts {
  std::vector<Eigen::Vector3d> half_axes;
  std::vector<double> shape_exponents;
};
struct PriorSource {
  std::string name;                         // as tables cite it
  std::map<std::string, LabelFacts> facts;  // by label
};

// The ground truth of a sequence; the table supplies how objects are mounted.
PriorSource SourceOfSequence(const Sequence& sequence, const SemanticTable& table, int min_views);
// The models of a catalogue that have a label.
PriorSource SourceOfCatalogue(const std::string& name, const std::vector<CatalogueModel>& models,
                              const CatalogueNames& names);

// The models without those that equal, to the millimetre, an object of a sequence with ground
// truth.
std::vector<CatalogueModel> WithoutObjectsOf(const Sequence& sequence,
                                             std::vector<CatalogueModel> models);

// The base table, updated row by row with the data of the sources; labels that it lacks become
// rows. Method: docs/priors.md. Throws InputError as LookUpTable.
SemanticRows LearnPriors(const SemanticRows& base, const std::vector<PriorSource>& sources,
                         const LearnPriorsOptions& options);

// The error of a label's prior for the true ratio of an object.
struct PriorError {
  std::string label;
  Eigen::Vector2d log_error;   // log of true / predicted (a / c, b / c)
  Eigen::Vector2d normalised;  // the same, divided by the prior's sigmas
};
// Errors for the objects with ground truth and a row (or default) in the table.
std::vector<PriorError> PriorErrors(const Sequence& sequence, const SemanticTable& table);

}  // namespace soslam
