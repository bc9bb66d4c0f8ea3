// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/mirror_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "base/wide_loops.h"
#include "image/sample_bilinear.h"

namespace soslam {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
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

// The pixels of points that are shifted first; NaN behind the camera.
SOSLAM_WIDE_LOOPS void Project(const Camera& camera, const BatchOfVectors& points,
                               const Eigen::Vector3d& shift, BatchOfPixels* pixels) {
  const auto [fx, fy, cx, cy] = std::tuple(camera.fx, camera.fy, camera.cx, camera.cy);
  const auto [shift_x, shift_y, shift_z] = std::tuple(shift.x(), shift.y(), shift.z());
  for (int i = 0; i < kBatchSize; ++i) {
    const double depth = points[2][i] + shift_z;
    const double inverse_depth = 1.0 / depth + (depth > 0.0 ? 0.0 : kNone);
    (*pixels)[0][i] = fx * (points[0][i] + shift_x) * inverse_depth + cx;
    (*pixels)[1][i] = fy * (points[1][i] + shift_y) * inverse_depth + cy;
  }
}

// d^2 / (d^2 + scale^2), and 1, for each pair; 0 where d^2 is NaN or infinite: there is no pair.
SOSLAM_WIDE_LOOPS void Count(const Batch& squared, double squared_scale, Batch* difference,
                             Batch* pair) {
  for (int i = 0; i < kBatchSize; ++i) {
    const double share = squared[i] / (squared[i] + squared_scale);
    const bool is_pair = share >= 0.0;
    (*difference)[i] = is_pair ? share : 0.0;
    (*pair)[i] = is_pair ? 1.0 : 0.0;
  }
}

}  // namespace

MirrorSearch::MirrorSearch(const SymmetryImage& image, const Camera& camera, Descriptor descriptor,
                           std::vector<Eigen::Vector2d> pixels)
    : map_(descriptor == Descriptor::kGrey ? image.maps.grey : image.maps.distance),
      unit_(descriptor == Descriptor::kGrey ? 1.0 / 255.0 : 1.0),
      camera_(camera),
      pixels_(std::move(pixels)),
      order_(InTurns(pixels_.size())),
      rays_(camera, Ordered(pixels_, order_)) {
  for (const size_t i : order_) {
    const auto sample = SampleBilinear(map_, pixels_[i]);
    values_.push_back(sample ? unit_ * sample->value : kNone);
  }
}

void MirrorSearch::See(const Landmark& landmark_in_camera, double min_viewing_cosine) {
  points_.Find(landmark_in_camera, rays_, min_viewing_cosine);
  values_of_points_.assign(points_.in_camera.size(), Batch::Zero());
  for (size_t i = 0; i < points_.ray.size(); ++i) {
    values_of_points_[i / kBatchSize][static_cast<Eigen::Index>(i % kBatchSize)] =
        values_[points_.ray[i]];
  }
  size_ = std::cbrt(landmark_in_camera.half_axes.prod());
  y_axis_ = landmark_in_camera.frame_from_object.rotation * Eigen::Vector3d::UnitY();
}

Batch MirrorSearch::SquaredDifferences(size_t batch, const Eigen::Vector3d& shift) const {
  BatchOfPixels pixels;
  Project(camera_, points_.in_camera[batch], shift, &pixels);
  return (values_of_points_[batch] - unit_ * SampleBilinear(map_, pixels)).square();
}

void MirrorSearch::Add(size_t batch, double squared_scale, Place* place) const {
  Batch difference, pair;
  Count(SquaredDifferences(batch, place->shift), squared_scale, &difference, &pair);
  place->sums.differences += difference.sum();
  place->sums.pairs += pair.sum();
}

std::optional<MirrorSearch::Least> MirrorSearch::FindLeast(const std::vector<double>& places,
                                                           double scale, double min_pairs) {
  std::optional<Least> least;
  const size_t batches = points_.in_camera.size();
  if (batches == 0) return least;
  const double squared_scale = scale * scale;
  places_.clear();
  for (size_t i = 0; i < places.size(); ++i) {
    places_.push_back({i, Shift(places[i]), {}});
    Add(0, squared_scale, &places_.back());
  }
  // The most promising place first: the others need not be looked at to the end.
  std::stable_sort(places_.begin(), places_.end(), [](const Place& one, const Place& other) {
    return one.sums.differences < other.sums.differences;
  });
  const auto most_pairs = static_cast<double>(points_.ray.size());
  for (Place& place : places_) {
    const double enough =
        least ? least->mean * most_pairs * kRounding : std::numeric_limits<double>::infinity();
    for (size_t batch = 1; batch < batches && place.sums.differences <= enough; ++batch) {
      Add(batch, squared_scale, &place);
    }
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
  for (size_t batch = 0; batch < points_.in_camera.size(); ++batch) {
    const Batch squared = SquaredDifferences(batch, Shift(place));
    for (int i = 0; i < kBatchSize; ++i) {
      if (!std::isfinite(squared[i])) continue;
      found.push_back(order_[points_.ray[batch * kBatchSize + static_cast<size_t>(i)]]);
    }
  }
  std::sort(found.begin(), found.end());
  return Ordered(pixels_, found);
}

}  // namespace soslam
