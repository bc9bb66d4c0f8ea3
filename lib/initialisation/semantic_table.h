// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/support_function.h"
#include "model/sequence.h"

namespace soslam {

// A positive quantity whose logarithm is normal.
struct LogNormal {
  double median;
  double log_sigma;  // standard deviation of the logarithm
};

// Which side of an upright thing its support plane is at: an object's frame has z away from there.
enum class Mount {
  kStanding,  // below it
  kHanging,   // above it, as a lamp's
  kOnWall,    // behind it, as a picture's
};
inline constexpr std::array kMountNames = {"standing", "hanging", "on_wall"};

// What is known of an object's size and shape before it is seen. Ratios are log-normal.
struct ShapePrior {
  Eigen::Vector2d ratio = Eigen::Vector2d::Ones();      // (a / c, b / c), medians
  Eigen::Vector2d log_sigma = Eigen::Vector2d::Ones();  // standard deviations of their logarithms
  double shape_exponent = kEllipsoidExponent;
  double log_correlation = 0.0;            // of the logarithms of the two ratios, in (-1, 1)
  std::optional<LogNormal> height_m = {};  // 2 c; none where the size is anybody's guess
  Mount mount = Mount::kStanding;
};

// The prior of the object's frame, whose z points away from its support, from one of things as they
// are upright (a is their depth, b their width, c their height), as tables have it: that of what is
// on a wall has its height along x and its depth along z. Ratios are taken to tell nothing of
// heights, so the spread of a depth is that of height and ratio together.
ShapePrior TurnedToSupport(const ShapePrior& prior);

// Lower case, without blanks, underscores and hyphens: "DiningTable" and "dining_table" are the
// same label.
std::string NormalisedLabel(const std::string& label);
bool AreSameLabel(const std::string& one, const std::string& other);

// SemTable of eq. (11), and how far it is to be trusted: what is known of an object by its label,
// as it is upright.
struct SemanticTable {
  std::map<std::string, ShapePrior> priors;  // by NormalisedLabel of labels and their aliases
  std::optional<ShapePrior> default_prior;   // for labels that are not in the table

  bool Contains(const std::string& label) const;
  // None when neither the label nor a default is there.
  std::optional<ShapePrior> Find(const std::string& label) const;
};

// A row of a semantic table as people write it.
struct SemanticRow {
  std::string label;
  std::vector<std::string> aliases;  // other names of the same things
  ShapePrior prior;
  int samples = 0;  // objects that the ratios were learned from; 0: general knowledge
  std::string source;
};

// A semantic table with where it comes from.
struct SemanticRows {
  std::string description;
  std::optional<SemanticRow> default_row;  // its label is "default"
  std::vector<SemanticRow> rows;           // sorted by label
};

// The table of all labels and aliases. Throws InputError when two of them are the same after
// NormalisedLabel.
SemanticTable LookUpTable(const SemanticRows& rows);

// Where an object's ratio comes from.
enum class RatioPrior {
  kTable,        // its label's entry in the semantic table
  kUnit,         // 1:1:1
  kGroundTruth,  // its own true ratio, to separate the prior's error from the method's
};
inline constexpr std::array kRatioPriorNames = {"table", "unit", "groundtruth"};

// Where an object's shape exponent comes from.
enum class ShapeSource {
  kTable,      // its label's entry in the semantic table
  kCuboid,     // cuboids all
  kEllipsoid,  // ellipsoids all, as in the paper
};
inline constexpr std::array kShapeSourceNames = {"table", "cuboid", "ellipsoid"};

// log_sigma of a true ratio: exact up to the annotation, which is taken to be good to 2 %.
inline constexpr double kTrueRatioLogSigma = 0.02;

// The prior of each object of the sequence, in its frame; none where there is no ratio. kUnit keeps
// all but the ratio of the table's prior, kGroundTruth the shape exponent only; of a default
// ShapePrior where the table has none.
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
