// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/options.h"
#include "model/sequence.h"
#include "model/shape_prior.h"

namespace soslam {

// SemTable of eq. (11) with uncertainties: priors by label, of upright objects.
struct SemanticTable {
  std::map<std::string, ShapePrior> priors;  // by NormalisedLabel of labels and their aliases
  std::optional<ShapePrior> default_prior;   // for labels that are not in the table

  bool Contains(const std::string& label) const;
  // None if the table has neither the label nor a default.
  std::optional<ShapePrior> Find(const std::string& label) const;
  // Prior of an object whose label may be uncertain: of the mixture of its labels. Labels of
  // another mount than the most probable one's are left out.
  std::optional<ShapePrior> Find(const Object& object) const;
};

// Row of a semantic table as written in a file.
struct SemanticRow {
  std::string label;
  std::vector<std::string> aliases;  // other names of the same things
  ShapePrior prior;
  int samples = 0;  // number of objects that the ratios were learned from; 0: general knowledge
  std::string source;
};

// Rows of a semantic table and their description.
struct SemanticRows {
  std::string description;
  std::optional<SemanticRow> default_row;  // its label is "default"
  std::vector<SemanticRow> rows;           // sorted by label
};

// Indices of the rows by NormalisedLabel of their labels and aliases. Throws InputError if two of
// these are the same.
std::map<std::string, size_t> RowsByName(const SemanticRows& rows);

// Table by the same names. Throws as RowsByName.
SemanticTable LookUpTable(const SemanticRows& rows);

// Source of an object's ratio.
enum class RatioPrior {
  kTable,        // its label's entry in the semantic table
  kUnit,         // 1:1:1
  kGroundTruth,  // its own true ratio, to separate the prior's error from the method's
};
inline constexpr std::array kRatioPriorNames = {"table", "unit", "groundtruth"};
inline void DescribeRatioPrior(OptionVisitor& visit, RatioPrior* prior) {
  visit.Choice("ratio_prior", prior, kRatioPriorNames,
               "where the size ratio of eq. (11) comes from");
}

// Source of an object's shape exponents.
enum class ShapeSource {
  kTable,      // its label's entry in the semantic table
  kCuboid,     // always a cuboid
  kEllipsoid,  // always an ellipsoid, as in the paper
};
inline constexpr std::array kShapeSourceNames = {"table", "cuboid", "ellipsoid"};
inline void DescribeShape(OptionVisitor& visit, ShapeSource* shape) {
  visit.Choice("shape", shape, kShapeSourceNames, "where the shape exponents come from");
}

// log_sigma of a true ratio: the error of the annotation, assumed to be 2 %.
inline constexpr double kTrueRatioLogSigma = 0.02;

// Prior of each object of the sequence, in the object frame of one that stands; none if there is no
// ratio. kUnit replaces the ratio of the table's prior, kGroundTruth also its log_sigma and
// log_correlation; if the table has no prior, those of a default ShapePrior.
std::vector<std::optional<ShapePrior>> ObjectPriors(const Sequence& sequence,
                                                    const SemanticTable& table, RatioPrior prior,
                                                    ShapeSource shape = ShapeSource::kTable);

// The ratios of ObjectPriors.
std::vector<std::optional<Eigen::Vector2d>> ObjectRatios(const Sequence& sequence,
                                                         const SemanticTable& table,
                                                         RatioPrior prior);

// Labels of the sequence's detected objects that are not in the table, sorted.
std::vector<std::string> LabelsWithoutEntry(const Sequence& sequence, const SemanticTable& table);

}  // namespace soslam
