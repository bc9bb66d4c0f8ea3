// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/mirror_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

#include "base/wide_loops.h"
#include "image/sample_batch.h"
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

// A batch of mirrored points and the values at their own pixels; NaN where there is no point.
struct Points {
  const BatchOfVectors& in_camera;
  const Batch& values;
};

// How points that are shifted first compare with the map there: adds d^2 / (d^2 + squared_scale)
// and numbers of pairs. `is_pair` is 1 or 0: d is NaN or infinite where there is no pair.
template <typename Scalar>
SOSLAM_IN_WIDE_LOOPS void Compare(const MapView<Scalar>& map, double unit, const Camera& camera,
                                  const Points& points, const Eigen::Vector3d& shift,
                                  double squared_scale, MirrorSearch::Sums* sums, Batch* is_pair) {
  // Copies, as what is written may be anything to the compiler.
  const auto [fx, fy, cx, cy] = std::tuple(camera.fx, camera.fy, camera.cx, camera.cy);
  const auto [shift_x, shift_y, shift_z] = std::tuple(shift.x(), shift.y(), shift.z());
  const MapView<Scalar> view = map;
  Cells cells;
  for (int i = 0; i < kBatchSize; i += 4) {
    Four x, y, depth;
    Load(points.in_camera[0].data() + i, &x);
    Load(points.in_camera[1].data() + i, &y);
    Load(points.in_camera[2].data() + i, &depth);
    depth += shift_z;
    const Four inverse_depth = depth > 0.0 ? 1.0 / depth : Four{} + kNone;
    cells.Locate(view, fx * (x + shift_x) * inverse_depth + cx,
                 fy * (y + shift_y) * inverse_depth + cy, i);
  }
  Four differences{}, pairs{};
  for (int i = 0; i < kBatchSize; i += 4) {
    Four value, mirrored;
    Load(points.values.data() + i, &value);
    SampleOfFour(view, cells, i).Interpolate(&mirrored);
    const Four difference = value - unit * mirrored;
    const Four squared = difference * difference;
    const Four share = squared / (squared + squared_scale);
    const FourMask known = share >= 0.0;
    const Four pair = known ? Four{} + 1.0 : Four{};
    differences += known ? share : Four{};
    pairs += pair;
    Store(pair, is_pair->data() + i);
  }
  sums->differences += Sum(differences);
  sums->pairs += Sum(pairs);
}

SOSLAM_WIDE_LOOPS void CompareBytes(const MapView<std::uint8_t>& map, double unit,
                                    const Camera& camera, const Points& points,
                                    const Eigen::Vector3d& shift, double squared_scale,
                                    MirrorSearch::Sums* sums, Batch* is_pair) {
  Compare(map, unit, camera, points, shift, squared_scale, sums, is_pair);
}

SOSLAM_WIDE_LOOPS void CompareFloats(const MapView<float>& map, double unit, const Camera& camera,
                                     const Points& points, const Eigen::Vector3d& shift,
                                     double squared_scale, MirrorSearch::Sums* sums,
                                     Batch* is_pair) {
  Compare(map, unit, camera, points, shift, squared_scale, sums, is_pair);
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

void MirrorSearch::Add(size_t batch, double squared_scale, const Eigen::Vector3d& shift, Sums* sums,
                       Batch* is_pair) const {
  const Points points{points_.in_camera[batch], values_of_points_[batch]};
  if (map_.type() == CV_8UC1) {
    CompareBytes(MapView<std::uint8_t>(map_), unit_, camera_, points, shift, squared_scale, sums,
                 is_pair);
  } else {
    CompareFloats(MapView<float>(map_), unit_, camera_, points, shift, squared_scale, sums,
                  is_pair);
  }
}

std::optional<MirrorSearch::Least> MirrorSearch::FindLeast(const std::vector<double>& places,
                                                           double scale, double min_pairs) {
  std::optional<Least> least;
  const size_t batches = points_.in_camera.size();
  if (batches == 0) return least;
  const double squared_scale = scale * scale;
  Batch is_pair;
  places_.clear();
  for (size_t i = 0; i < places.size(); ++i) {
    places_.push_back({i, Shift(places[i]), {}});
    Add(0, squared_scale, places_.back().shift, &places_.back().sums, &is_pair);
  }
  // The most promising place first: the others need not be looked at to the end.
  std::iter_swap(places_.begin(), std::ranges::min_element(places_, {}, [](const Place& place) {
                   return place.sums.differences;
                 }));
  const auto most_pairs = static_cast<double>(points_.ray.size());
  for (Place& place : places_) {
    const double enough =
        least ? least->mean * most_pairs * kRounding : std::numeric_limits<double>::infinity();
    for (size_t batch = 1; batch < batches && place.sums.differences <= enough; ++batch) {
      Add(batch, squared_scale, place.shift, &place.sums, &is_pair);
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
    Batch is_pair;
    Sums sums;
    Add(batch, 1.0, Shift(place), &sums, &is_pair);
    for (int i = 0; i < kBatchSize; ++i) {
      if (is_pair[i] == 0.0) continue;
      found.push_back(order_[points_.ray[batch * kBatchSize + static_cast<size_t>(i)]]);
    }
  }
  std::sort(found.begin(), found.end());
  return Ordered(pixels_, found);
}

}  // namespace soslam
