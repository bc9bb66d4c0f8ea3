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

// What one data set says about a label: half axes along x (front), y and z (up) of the
// upright thing, in metres, one per object; shape exponents of those objects whose boxes show it.
struct LabelFacts {
  std::vector<Eigen::Vector3d> half_axes;
  std::vector<double> shape_exponents;
};
struct PriorSource {
  std::string name;                         // as tables cite it
  std::map<std::string, LabelFacts> facts;  // by label
};

// The ground truth of a sequence; the table says how things are mounted.
PriorSource SourceOfSequence(const Sequence& sequence, const SemanticTable& table, int min_views);
// The models of a catalogue that have a label.
PriorSource SourceOfCatalogue(const std::string& name, const std::vector<CatalogueModel>& models,
                              const CatalogueNames& names);

// The models that are not, to the millimetre, objects of a sequence with ground truth.
std::vector<CatalogueModel> WithoutObjectsOf(const Sequence& sequence,
                                             std::vector<CatalogueModel> models);

// The base table with what the sources say, row by row; labels that it lacks become rows. How:
// docs/priors.md. Throws InputError as LookUpTable.
SemanticRows LearnPriors(const SemanticRows& base, const std::vector<PriorSource>& sources,
                         const LearnPriorsOptions& options);

// An object's true ratio against its label's prior.
struct PriorError {
  std::string label;
  Eigen::Vector2d log_error;   // log of true / predicted (a / c, b / c)
  Eigen::Vector2d normalised;  // the same, divided by the prior's sigmas
};
// Of the objects with ground truth and a row (or default) in the table.
std::vector<PriorError> PriorErrors(const Sequence& sequence, const SemanticTable& table);

}  // namespace soslam
