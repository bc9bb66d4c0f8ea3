// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/mirror_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/wide_loops.h"
#include "image/sample_batch.h"
#include "image/sample_bilinear.h"
#include "image/sample_of_eight.h"

namespace soslam {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
// Bounds may be off by what rounding does to a sum.
constexpr double kRounding = 1.0 + 1e-9;

// Pixels come row by row. Taken in this many turns, each batch has some of all rows, and the first
// one already says much about a place.
std::vector<size_t> InTurns(size_t count) {
  constexpr size_t kTurns = 16;
  std::vector<size_t> order;
  for (size_t turn = 0; turn < kTurns; ++turn) {
    for (size_t i = turn; i < count; i += kTurns) order.push_back(i);
  }
  return order;
}

template <typename T>
std::vector<T> Ordered(const std::vector<T>& values, const std::vector<size_t>& order) {
  std::vector<T> ordered;
  for (const size_t i : order) ordered.push_back(values[i]);
  return ordered;
}

// Of the pixels of grey values 0 to 1, or of distances in px.
cv::Mat MapOf(const EdgeMaps& maps, Descriptor descriptor) {
  if (descriptor != Descriptor::kGrey) return maps.distance;
  cv::Mat grey;
  maps.grey.convertTo(grey, CV_32F, 1.0 / 255.0);
  return grey;
}

// Mirrored points (see MirroredPoints) and the values at the points' own pixels.
struct Points {
  std::array<const float*, 3> in_image;
  const float* values;
};

Points PointsOf(const MirroredPoints& points, const std::vector<float>& values) {
  const auto& [x, y, depth] = points.in_image;
  return {{x.data(), y.data(), depth.data()}, values.data()};
}

// How they compare with the map where they are when shifted.
struct Comparison {
  MapView<float> map;
  Eigen::Vector3f shift;
  float squared_scale;
};

// d^2 / (d^2 + squared_scale) of a batch; NaN where there is no pair, as d is NaN or infinite.
using Shares = std::array<Eight, kBatchSize / 8>;
SOSLAM_IN_WIDE_LOOPS void FindShares(const Comparison& comparison, const Points& points,
                                     size_t batch, Shares* shares) {
  CellsOfEight cells;
  for (size_t i = 0; i < shares->size(); ++i) {
    const size_t at = batch * kBatchSize + 8 * i;
    Eight x, y, depth;
    Load(points.in_image[0] + at, &x);
    Load(points.in_image[1] + at, &y);
    Load(points.in_image[2] + at, &depth);
    depth += comparison.shift[2];
    const Eight inverse_depth = depth > 0.0F ? 1.0F / depth : Eight{} + kNone;
    cells.Locate(comparison.map, (x + comparison.shift[0]) * inverse_depth,
                 (y + comparison.shift[1]) * inverse_depth, i);
  }
  for (size_t i = 0; i < shares->size(); ++i) {
    Eight value, mirrored;
    Load(points.values + batch * kBatchSize + 8 * i, &value);
    Interpolate(comparison.map, cells, i, &mirrored);
    const Eight difference = value - mirrored;
    const Eight squared = difference * difference;
    (*shares)[i] = squared / (squared + comparison.squared_scale);
  }
}

// Adds batches from `first` on, as long as they come to no more than `enough`.
SOSLAM_WIDE_LOOPS void Add(const Comparison& comparison, const Points& points, size_t first,
                           size_t end, double enough, MirrorSearch::Sums* sums) {
  const Comparison copy = comparison;  // what is written may be anything to the compiler
  double differences = sums->differences;
  EightIntegers pairs{};
  for (size_t batch = first; batch < end && differences <= enough; ++batch) {
    Shares shares;
    FindShares(copy, points, batch, &shares);
    Eight sum{};
    for (const Eight& share : shares) {
      const EightMask known = share >= 0.0F;
      sum += known ? share : Eight{};
      pairs -= known;
    }
    differences += Sum(sum);
  }
  sums->differences = differences;
  for (size_t i = 0; i < 8; ++i) sums->pairs += pairs[i];
}

// Which ones of a batch are pairs.
SOSLAM_WIDE_LOOPS void FindPairs(const Comparison& comparison, const Points& points, size_t batch,
                                 std::array<bool, kBatchSize>* is_pair) {
  Shares shares;
  FindShares(comparison, points, batch, &shares);
  for (size_t i = 0; i < kBatchSize; ++i) (*is_pair)[i] = shares[i / 8][i % 8] >= 0.0F;
}

}  // namespace

MirrorSearch::MirrorSearch(const SymmetryImage& image, const Camera& camera, Descriptor descriptor,
                           std::vector<Eigen::Vector2d> pixels)
    : map_(MapOf(image.maps, descriptor)),
      pixels_(std::move(pixels)),
      order_(InTurns(pixels_.size())),
      rays_(camera, Ordered(pixels_, order_)) {
  for (const size_t i : order_) {
    const auto sample = SampleBilinear(map_, pixels_[i]);
    values_.push_back(sample ? static_cast<float>(sample->value) : kNone);
  }
}

void MirrorSearch::See(const Landmark& landmark_in_camera, double min_viewing_cosine) {
  points_.Find(landmark_in_camera, rays_, min_viewing_cosine);
  values_of_points_.resize(points_.in_image[0].size());
  for (size_t i = 0; i < points_.ray.size(); ++i) values_of_points_[i] = values_[points_.ray[i]];
  const double size = std::cbrt(landmark_in_camera.half_axes.prod());
  const Eigen::Vector3d y_axis =
      landmark_in_camera.frame_from_object.rotation * Eigen::Vector3d::UnitY();
  shift_by_place_ = rays_.camera.Intrinsics() * (2.0 * size * y_axis);
}

void MirrorSearch::Add(size_t first, size_t end, double enough, double scale, Place* place) const {
  soslam::Add({MapView<float>(map_), place->shift, static_cast<float>(scale * scale)},
              PointsOf(points_, values_of_points_), first, end, enough, &place->sums);
}

std::optional<MirrorSearch::Least> MirrorSearch::FindLeast(const std::vector<double>& places,
                                                           double scale, double min_pairs) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::optional<Least> least;
  const size_t batches = points_.NumBatches();
  if (batches == 0) return least;
  places_.clear();
  for (size_t i = 0; i < places.size(); ++i) {
    places_.push_back({i, Shift(places[i]), {}});
    Add(0, 1, kInfinity, scale, &places_.back());
  }
  // The most promising place first: the others need not be looked at to the end.
  std::iter_swap(places_.begin(), std::ranges::min_element(places_, {}, [](const Place& place) {
                   return place.sums.differences;
                 }));
  const auto most_pairs = static_cast<double>(points_.ray.size());
  for (Place& place : places_) {
    const double enough = least ? least->mean * most_pairs * kRounding : kInfinity;
    Add(1, batches, enough, scale, &place);
    if (place.sums.differences > enough || place.sums.pairs < min_pairs) continue;
    const double mean = place.sums.differences / place.sums.pairs;
    if (!least || mean < least->mean || (mean == least->mean && place.index < least->place)) {
      least = Least{mean, place.index};
    }
  }
  return least;
}

std::vector<Eigen::Vector2d> MirrorSearch::PixelsOfPairs(double place) const {
  std::vector<size_t> found;
  for (size_t batch = 0; batch < points_.NumBatches(); ++batch) {
    std::array<bool, kBatchSize> is_pair;
    FindPairs({MapView<float>(map_), Shift(place), 1.0F}, PointsOf(points_, values_of_points_),
              batch, &is_pair);
    for (size_t i = 0; i < kBatchSize; ++i) {
      if (is_pair[i]) found.push_back(order_[points_.ray[batch * kBatchSize + i]]);
    }
  }
  std::sort(found.begin(), found.end());
  return Ordered(pixels_, found);
}

}  // namespace soslam
