// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "soslam/base/options.h"
#include "soslam/model/sequence.h"
#include "soslam/model/shape_prior.h"

namespace soslam {

// SemTable of eq. (11) with uncertainties: priors by label, of upright objects.
struct SemanticTable {
  std::map<std::string, ShapePrior> priors;  // by NormalisedLabel of labels and their aliases
  std::optional<ShapePrior> default_prior;   // for labels that are not in the table

  bool Contains(const std::string& label) const;
  // Empty if the table has neither the label nor a default.
  std::optional<ShapePrior> Find(const std::string& label) const;
  // Prior of an object whose label may be uncertain: of the mixture of its labels, with what is
  // known of its size. Labels of another mount than the most probable one's are left out.
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

// An entry of the file, whose key is the label.
template <typename Visitor>
void Describe(Visitor& visit, SemanticRow& row) {
  constexpr double kLogSigma = 0.3, kShapeExponent = 1.1;  // of entries that have a ratio only
  constexpr Limits kCorrelation = {-0.99, 0.99}, kBias = {-1.0, 0.4};
  ShapePrior& prior = row.prior;
  visit.Field("a_by_c", &prior.ratio.x(), "a / c: depth by height", kPositive);
  visit.Field("b_by_c", &prior.ratio.y(), "b / c: width by height", kPositive);
  visit.OrDefault("a_by_c_log_sigma", &prior.log_sigma.x(), kLogSigma,
                  "standard deviation of log(a / c) among objects of the label", kPositive);
  visit.OrDefault("b_by_c_log_sigma", &prior.log_sigma.y(), kLogSigma,
                  "standard deviation of log(b / c) among objects of the label", kPositive);
  DescribeExponents(visit, prior.shape_exponents, kShapeExponent);
  visit.OrDefault("log_correlation", &prior.log_correlation, 0.0,
                  "of log(a / c) and log(b / c) among objects of the label", kCorrelation);
  std::optional<double> height_m, height_log_sigma;
  if (prior.height_m)
    height_m = prior.height_m->median, height_log_sigma = prior.height_m->log_sigma;
  visit.OrAbsent("height_m", &height_m, "2 c: median height, metres; absent: the size is not known",
                 kPositive);
  visit.OrAbsent("height_log_sigma", &height_log_sigma,
                 "standard deviation of log(height) among objects of the label; 0.3 if absent",
                 kPositive);
  visit.AfterReading([&] {
    prior.height_m.reset();
    if (height_m) prior.height_m = {*height_m, height_log_sigma.value_or(kLogSigma)};
  });
  visit.OrAbsent("mount", &prior.mount,
                 "side of the upright thing that its support plane is at: below (standing), above "
                 "(hanging, as a lamp from a ceiling) or behind (on_wall, as a picture)");
  visit.OrAbsent("attitude", &prior.attitude,
                 "how the thing may be held by its support plane: with the face of its mount on it "
                 "(standing), with its bottom, back or side on it (any_face), or leaning, so that "
                 "the plane only touches it (free). any_face and free need the mount standing");
  visit.Check([&] {
    return prior.attitude == Attitude::kStanding || prior.mount == Mount::kStanding
               ? std::string()
               : std::string("attitude is ") + NameOf(prior.attitude) + " and mount " +
                     NameOf(prior.mount) + "; expected standing for one of the two";
  });
  visit.OrAbsent("has_front", &prior.has_front,
                 "the x axis of the thing is a front that people agree on, as that of a chair, a "
                 "screen or a car, but not of a table, a cup or a ball");
  visit.Check([&] {
    return prior.has_front && prior.mount == Mount::kOnWall
               ? std::string(
                     "has_front is true and mount on_wall; expected one of the two, as the "
                     "front of a thing on a wall points away from that")
               : std::string();
  });
  visit.OrAbsent("edge_bias", &prior.edge_bias,
                 "mean distance by which the left, top, right and bottom edges of a detector's "
                 "boxes lie outside the outline of the body, as fractions of the width or height "
                 "of the box; negative: inside",
                 kBias);
  visit.OrDefault("samples", &row.samples, 0,
                  "objects that the ratios were learned from; 0: general knowledge", kNotNegative);
  visit.OrAbsent("aliases", &row.aliases,
                 "other names of the label; case, blanks, underscores and hyphens do not count",
                 kNotEmpty);
  visit.Field("source", &row.source, "where the numbers come from", kNotEmpty);
}

template <typename Visitor>
void Describe(Visitor& visit, SemanticRows& rows) {
  visit.OrDefault("description", &rows.description, std::string(), "what the table is of");
  visit.OrAbsent("default", &rows.default_row,
                 "for labels that are not listed; absent: objects of such labels are left out");
  std::map<std::string, SemanticRow> labels;
  for (const SemanticRow& row : rows.rows) labels[row.label] = row;
  visit.Field(
      "labels", &labels,
      "entries by label: SemTable of eq. (11), a, b and c the half axes along x (front), y (left) "
      "and z (up) of the upright thing");
  visit.AfterReading([&] {
    if (rows.default_row) rows.default_row->label = "default";
    rows.rows.clear();
    for (auto& [label, row] : labels) {
      row.label = label;
      rows.rows.push_back(row);
    }
  });
}

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
