// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "constraints/tangency.h"
#include "geometry/landmark.h"
#include "geometry/support_function.h"
#include "model/sequence.h"

namespace soslam {

// A positive quantity whose logarithm is normal.
struct LogNormal {
  double median;
  double log_sigma;  // standard deviation of the logarithm
};

// Side of an upright object where its support plane is. The object frame has z pointing away from
// the plane.
enum class Mount {
  kStanding,  // below the object
  kHanging,   // above it, as for a lamp
  kOnWall,    // behind it, as for a picture
};
inline constexpr std::array kMountNames = {"standing", "hanging", "on_wall"};

// How an object may be held by its support plane.
enum class Attitude {
  kStanding,  // with the face of its mount on the plane
  kAnyFace,   // with its bottom, back or side on the plane
  kFree,      // leaning: the plane only touches it
};
inline constexpr std::array kAttitudeNames = {"standing", "any_face", "free"};

// Prior of an object's size and shape. Ratios are log-normal.
struct ShapePrior {
  Eigen::Vector2d ratio = Eigen::Vector2d::Ones();      // (a / c, b / c), medians
  Eigen::Vector2d log_sigma = Eigen::Vector2d::Ones();  // standard deviations of their logarithms
  ShapeExponents shape_exponents = kEllipsoidExponent;
  double log_correlation = 0.0;            // of the logarithms of the two ratios, in (-1, 1)
  std::optional<LogNormal> height_m = {};  // along its own z axis; none if the size is unknown
  Mount mount = Mount::kStanding;
  EdgeBias edge_bias = {};  // of detected boxes, for this shape
  Attitude attitude = Attitude::kStanding;
  RestingFace rests_on = RestingFace::kBottom;  // the face that a, b and c are for
};

// The prior in the object frame, whose z points away from the support plane, from a prior of
// upright objects as tables have it (a is the depth, b the width, c the height): an object on a
// wall has its height along x and its depth along z. Ratios are assumed to be independent of
// heights, so the variance of the logarithm of a depth is the sum of those of height and ratio.
ShapePrior TurnedToSupport(const ShapePrior& prior);

// The same for an object that rests on a face, from the prior of one that stands; height_m stays
// that of its own z axis.
ShapePrior OnFace(const ShapePrior& standing, RestingFace face);

// OnFace for each face that the prior's attitude allows; none for no prior.
std::vector<std::optional<ShapePrior>> OnPossibleFaces(const std::optional<ShapePrior>& standing);

// Log-normal prior with the moments of a mixture of priors of one mount; the height is that of the
// priors that have one, the attitude that of the first. Their weights have the sum 1.
struct WeightedPrior {
  double weight;
  ShapePrior prior;
};
ShapePrior MomentsOfMixture(const std::vector<WeightedPrior>& priors);

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

// Source of an object's shape exponents.
enum class ShapeSource {
  kTable,      // its label's entry in the semantic table
  kCuboid,     // always a cuboid
  kEllipsoid,  // always an ellipsoid, as in the paper
};
inline constexpr std::array kShapeSourceNames = {"table", "cuboid", "ellipsoid"};

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
