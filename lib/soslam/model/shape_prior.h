// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "soslam/base/description.h"
#include "soslam/geometry/landmark.h"

namespace soslam {

// A positive quantity whose logarithm is normal.
struct LogNormal {
  double median;
  double log_sigma;  // standard deviation of the logarithm
};

// A length along an axis (0, 1, 2: x, y, z) of an object.
struct LengthAlongAxis {
  LogNormal length_m;
  Eigen::Index axis;
};

// Lengths of one thing that somebody has measured.
struct KnownSize {
  std::optional<double> depth_m = {}, width_m = {}, height_m = {};

  bool Any() const { return depth_m || width_m || height_m; }
};
template <typename Visitor>
void Describe(Visitor& visit, KnownSize& size) {
  visit.OrAbsent("depth_m", &size.depth_m, "from front to back of the upright thing", kPositive);
  visit.OrAbsent("width_m", &size.width_m, "from side to side", kPositive);
  visit.OrAbsent("height_m", &size.height_m, "from bottom to top", kPositive);
}

// Side of an upright object where its support plane is. The object frame has z pointing away from
// the plane.
enum class Mount {
  kStanding,  // below the object
  kHanging,   // above it, as for a lamp
  kOnWall,    // behind it, as for a picture
};
inline constexpr std::array kMountNames = {"standing", "hanging", "on_wall"};
inline constexpr const auto& NamesOf(Mount) { return kMountNames; }

// How an object may be held by its support plane.
enum class Attitude {
  kStanding,  // with the face of its mount on the plane
  kAnyFace,   // with its bottom, back or side on the plane
  kFree,      // leaning: the plane only touches it
};
inline constexpr std::array kAttitudeNames = {"standing", "any_face", "free"};
inline constexpr const auto& NamesOf(Attitude) { return kAttitudeNames; }

// Mean distances by which the edges of a detector's boxes (left, top, right, bottom) lie outside
// the outline of the body, as fractions of the width or height of the box; negative: inside. Those
// of opposite edges have a sum below 1.
using EdgeBias = std::array<double, 4>;

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
  bool has_front = false;  // its x axis is a front that people agree on, as that of a chair
  // Known of the object itself and not of its label, along one of its own axes.
  std::optional<LengthAlongAxis> known_length = {};

  // True if the object can only stand on its bottom.
  bool Stands() const { return mount == Mount::kStanding && attitude == Attitude::kStanding; }
  // The length that tells how large the object is, along an axis of the object frame: the known one
  // or the height; none if the size is unknown.
  std::optional<LengthAlongAxis> Length() const;
};

// The prior in the object frame, whose z points away from the support plane, from a prior of
// upright objects as tables have it (a is the depth, b the width, c the height): an object on a
// wall has its height along x and its depth along z. Ratios are assumed to be independent of
// heights, so the variance of the logarithm of a depth is the sum of those of height and ratio.
ShapePrior TurnedToSupport(const ShapePrior& prior);

// The prior of an object that rests on a face, from that of one that stands; height_m stays
// that of its own z axis.
ShapePrior OnFace(const ShapePrior& standing, RestingFace face);

// OnFace for each face that the prior's attitude allows; none for no prior.
std::vector<std::optional<ShapePrior>> OnPossibleFaces(const std::optional<ShapePrior>& standing);

// The prior times the likelihood of the logarithms of its two ratios, normal with these means and
// variances, independent of each other.
ShapePrior TimesRatioLikelihood(const ShapePrior& prior, const Eigen::Vector2d& mean,
                                const Eigen::Vector2d& variance);

// The prior of an object of which some lengths are known, to 0.5 %: ratios of known lengths and
// height_m follow from them. The same prior if none is.
ShapePrior WithKnownSize(const ShapePrior& prior, const KnownSize& size);

// Log-normal prior with the moments of a mixture of priors of one mount; the height is that of the
// priors that have one; attitude and has_front are those of the first. Weights have the sum 1.
struct WeightedPrior {
  double weight;
  ShapePrior prior;
};
ShapePrior MomentsOfMixture(const std::vector<WeightedPrior>& priors);

}  // namespace soslam
