// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/mirror_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <tuple>
#include <utility>

#include "base/simd.h"
#include "image/neighbours.h"
#include "image/sample_bilinear.h"

namespace soslam {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
// Tolerance of lower bounds for rounding errors of sums.
constexpr double kRounding = 1.0 + 1e-9;

// Interleaved order. Pixels come row by row; with this stride each batch has pixels from all rows,
// so that the first batch is already representative.
std::vector<size_t> InterleavedOrder(size_t count) {
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

// Map of a descriptor: grey values from 0 to 1, or distances in px.
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

// Bounds of the pixels of all points at both shifts; NaN if a point is behind the camera.
SOSLAM_MULTIVERSION void FindBounds(const Points& points, size_t batches,
                                    const std::array<Eigen::Vector3f, 2>& shifts,
                                    PixelBounds* bounds) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Eight least_x = Eight{} + kInfinity, least_y = least_x, least_depth = least_x;
  Eight largest_x = Eight{} - kInfinity, largest_y = largest_x;
  for (size_t at = 0; at < batches * kBatchSize; at += 8) {
    Eight x, y, depth;
    Load(points.in_image[0] + at, &x);
    Load(points.in_image[1] + at, &y);
    Load(points.in_image[2] + at, &depth);
    for (const Eigen::Vector3f& shift : shifts) {
      const Eight shifted_depth = depth + shift[2];
      const Eight inverse_depth = 1.0F / shifted_depth;
      const Eight pixel_x = (x + shift[0]) * inverse_depth;
      const Eight pixel_y = (y + shift[1]) * inverse_depth;
      least_x = pixel_x < least_x ? pixel_x : least_x;
      least_y = pixel_y < least_y ? pixel_y : least_y;
      least_depth = shifted_depth < least_depth ? shifted_depth : least_depth;
      largest_x = pixel_x > largest_x ? pixel_x : largest_x;
      largest_y = pixel_y > largest_y ? pixel_y : largest_y;
    }
  }
  *bounds = {kInfinity, kInfinity, -kInfinity, -kInfinity};
  for (size_t i = 0; i < 8; ++i) {
    bounds->least_x = std::min(bounds->least_x, least_x[i]);
    bounds->least_y = std::min(bounds->least_y, least_y[i]);
    bounds->largest_x = std::max(bounds->largest_x, largest_x[i]);
    bounds->largest_y = std::max(bounds->largest_y, largest_y[i]);
    if (!(least_depth[i] > 0.0F)) *bounds = {kNone, kNone, kNone, kNone};
  }
}

// The map, and the squared scale of the loss.
struct Comparison {
  Neighbours::View map;
  float squared_scale;
};

// Position of each point of a batch in the map, when shifted.
template <bool may_be_outside>
SOSLAM_FORCE_INLINE void Locate(const Neighbours::View& map, const Points& points, size_t batch,
                                const Eigen::Vector3f& shift, CellsOfEight* cells) {
  for (size_t i = 0; i < CellsOfEight::kCount; ++i) {
    const size_t at = batch * kBatchSize + 8 * i;
    Eight x, y, depth;
    Load(points.in_image[0] + at, &x);
    Load(points.in_image[1] + at, &y);
    Load(points.in_image[2] + at, &depth);
    depth += shift[2];
    Eight inverse_depth = 1.0F / depth;
    if constexpr (may_be_outside) {
      inverse_depth = depth > 0.0F ? inverse_depth : Eight{} + kNone;
    }
    cells->Locate<may_be_outside>(map, (x + shift[0]) * inverse_depth,
                                  (y + shift[1]) * inverse_depth, i);
  }
}

// d^2 for the i-th eight points of the batch; NaN or infinite if there is no pair.
SOSLAM_FORCE_INLINE void FindSquares(const Comparison& comparison, const Points& points,
                                     size_t batch, const CellsOfEight& cells, size_t i,
                                     Eight* squares) {
  Eight values, mirrored;
  Load(points.values + batch * kBatchSize + 8 * i, &values);
  Interpolate(comparison.map, cells, i, &mirrored);
  const Eight differences = values - mirrored;
  *squares = differences * differences;
}

// d^2 / (d^2 + squared_scale); NaN if there is no pair.
SOSLAM_FORCE_INLINE void ToShare(const Comparison& comparison, Eight* square) {
  *square = *square / (*square + comparison.squared_scale);
}

// Adds batches of points to the sums of each candidate.
template <bool may_be_outside>
SOSLAM_FORCE_INLINE void Add(const Comparison& comparison, const Points& points, size_t first,
                             size_t end, std::span<MirrorSearch::Candidate* const> places) {
  const Comparison copy = comparison;  // a local copy cannot overlap the output
  for (MirrorSearch::Candidate* place : places) {
    const Eigen::Vector3f shift = place->shift;
    double differences = place->differences;
    EightIntegers pairs;
    std::memcpy(&pairs, &place->pairs, sizeof(pairs));
    for (size_t batch = first; batch < end; ++batch) {
      CellsOfEight cells;
      Locate<may_be_outside>(copy.map, points, batch, shift, &cells);
      ReadFromMemory(cells);
      // Divisions follow in a loop of their own, so that none waits for another.
      std::array<Eight, CellsOfEight::kCount> shares;
      for (size_t i = 0; i < shares.size(); ++i) {
        FindSquares(copy, points, batch, cells, i, &shares[i]);
      }
      Eight sum{};
      for (Eight& share : shares) {
        ToShare(copy, &share);
        const EightMask known = share >= 0.0F;
        sum += known ? share : Eight{};
        pairs -= known;
      }
      differences += Sum(sum);
    }
    place->differences = differences;
    std::memcpy(&place->pairs, &pairs, sizeof(pairs));
  }
}

SOSLAM_MULTIVERSION void AddInside(const Comparison& comparison, const Points& points, size_t first,
                                   size_t end, std::span<MirrorSearch::Candidate* const> places) {
  Add<false>(comparison, points, first, end, places);
}

SOSLAM_MULTIVERSION void AddAnywhere(const Comparison& comparison, const Points& points,
                                     size_t first, size_t end,
                                     std::span<MirrorSearch::Candidate* const> places) {
  Add<true>(comparison, points, first, end, places);
}

// Finds which points of a batch form pairs.
SOSLAM_MULTIVERSION void FindPairs(const Comparison& comparison, const Points& points, size_t batch,
                                   const Eigen::Vector3f& shift,
                                   std::array<bool, kBatchSize>* is_pair) {
  CellsOfEight cells;
  Locate<true>(comparison.map, points, batch, shift, &cells);
  for (size_t i = 0; i < CellsOfEight::kCount; ++i) {
    Eight shares;
    FindSquares(comparison, points, batch, cells, i, &shares);
    ToShare(comparison, &shares);
    for (size_t k = 0; k < 8; ++k) (*is_pair)[8 * i + k] = shares[k] >= 0.0F;
  }
}

}  // namespace

MirrorSearch::MirrorSearch(const SymmetryImage& image, const Camera& camera, Descriptor descriptor,
                           std::vector<Eigen::Vector2d> pixels)
    : MirrorSearch(MapOf(image.maps, descriptor), camera, std::move(pixels)) {}

MirrorSearch::MirrorSearch(const cv::Mat& map, const Camera& camera,
                           std::vector<Eigen::Vector2d> pixels)
    : map_(map),
      pixels_(std::move(pixels)),
      order_(InterleavedOrder(pixels_.size())),
      rays_(camera, Ordered(pixels_, order_)) {
  for (const size_t i : order_) {
    const auto sample = SampleBilinear(map, pixels_[i]);
    values_.push_back(sample ? static_cast<float>(sample->value) : kNone);
  }
}

void MirrorSearch::SetLandmark(const Landmark& landmark_in_camera, double min_viewing_cosine) {
  points_.Find(landmark_in_camera, rays_, min_viewing_cosine);
  values_of_points_.assign(points_.in_image[0].size(), kNone);
  for (size_t i = 0; i < points_.ray.size(); ++i) values_of_points_[i] = values_[points_.ray[i]];
  const double size = std::cbrt(landmark_in_camera.half_axes.prod());
  const Eigen::Vector3d y_axis =
      landmark_in_camera.frame_from_object.rotation * Eigen::Vector3d::UnitY();
  shift_by_place_ = rays_.camera.Intrinsics() * (2.0 * size * y_axis);
}

// The pixel of a point moves along a line with the offset, so two ends bound all in between.
void MirrorSearch::SelectInBounds(double least_place, double largest_place) {
  PixelBounds bounds;
  FindBounds(PointsOf(points_, values_of_points_), points_.NumBatches(),
             {Shift(least_place), Shift(largest_place)}, &bounds);
  map_.SelectInBounds(bounds);
  are_inside_ = map_.AreInside(bounds);
}

void MirrorSearch::Add(size_t first, size_t end, double scale, std::span<Candidate* const> places) {
  const auto add = are_inside_ ? AddInside : AddAnywhere;
  add({map_.view(), static_cast<float>(scale * scale)}, PointsOf(points_, values_of_points_), first,
      end, places);
}

std::optional<MirrorSearch::Minimum> MirrorSearch::FindMinimum(const std::vector<double>& places,
                                                               double scale, double min_pairs) {
  const size_t batches = points_.NumBatches();
  if (batches == 0) return std::nullopt;
  const auto [least_place, largest_place] = std::ranges::minmax(places);
  SelectInBounds(least_place, largest_place);
  places_.assign(places.size(), {});
  for (size_t i = 0; i < places.size(); ++i) places_[i].shift = Shift(places[i]);
  // The best candidate for the last landmark comes first: its mean rejects others early. Those are
  // interleaved batch by batch, so that the processor need not wait for each one's sum.
  Candidate& likely = places_[last_least_ < places.size() ? last_least_ : 0];
  Add(0, batches, scale, std::array{&likely});
  const double enough = likely.NumPairs() < min_pairs
                            ? std::numeric_limits<double>::infinity()
                            : likely.differences / likely.NumPairs() *
                                  static_cast<double>(points_.ray.size()) * kRounding;
  open_.clear();
  for (Candidate& place : places_) {
    if (&place != &likely) open_.push_back(&place);
  }
  for (size_t batch = 0; batch < batches; ++batch) {
    Add(batch, batch + 1, scale, open_);
    std::erase_if(open_, [&](const Candidate* place) { return place->differences > enough; });
  }
  open_.push_back(&likely);
  std::optional<Minimum> least;
  for (const Candidate* place : open_) {
    if (place->NumPairs() < min_pairs) continue;
    const Minimum of_place{place->differences / place->NumPairs(),
                           static_cast<size_t>(place - places_.data())};
    if (!least || std::tie(of_place.mean, of_place.place) < std::tie(least->mean, least->place)) {
      least = of_place;
    }
  }
  if (least) last_least_ = least->place;
  return least;
}

std::vector<Eigen::Vector2d> MirrorSearch::PixelsOfPairs(double place) {
  std::vector<size_t> found;
  SelectInBounds(place, place);
  for (size_t batch = 0; batch < points_.NumBatches(); ++batch) {
    std::array<bool, kBatchSize> is_pair;
    FindPairs({map_.view(), 1.0F}, PointsOf(points_, values_of_points_), batch, Shift(place),
              &is_pair);
    for (size_t i = 0; i < kBatchSize; ++i) {
      if (is_pair[i]) found.push_back(order_[points_.ray[batch * kBatchSize + i]]);
    }
  }
  std::ranges::sort(found);
  return Ordered(pixels_, found);
}

}  // namespace soslam
