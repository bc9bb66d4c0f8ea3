// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/view_weights.h"

#include <algorithm>
#include <array>

#include "base/exponential_of_four.h"
#include "base/wide_loops.h"

namespace soslam {
namespace {

struct alignas(kFourAlignment) FourViews {
  ThreeFours direction{};  // unit vectors
  Four is_any{};           // 1; 0 beyond the last
  Four similar_views{};    // the sum of similarities
};
// Of four views with four others, row by row.
using Pairs = std::array<Four, 4>;

// Of directions, by the squares of the chords between them, s = (2 sin(angle / 2))^2. Of a quarter
// of the angle that is
//   (s / 4) / ((1 + c) (1 + sqrt((1 + c) / 2))) with c = cos(angle / 2) = sqrt(1 - s / 4),
// and of what is left, 45 degrees at most,
//   angle^2 = sum over n of 2 s^n / (n^2 (2n over n)).
SOSLAM_IN_WIDE_LOOPS void SquaredAngles(Pairs chords, Pairs* angles) {
  constexpr double kSquaredQuarter = 16.0;  // back to the whole angle
  constexpr auto kFactors = SeriesByRatios<12>(
      kSquaredQuarter, [](double n) { return n * n / (2.0 * (n + 1.0) * (2.0 * n + 1.0)); });
  for (Four& chord : chords) {
    const Four quarter = 0.25 * chord;
    Four cosine = 1.0 - quarter;
    cosine = cosine > 0.0 ? cosine : Four{};
    SquareRoot(cosine, &cosine);
    Four cosine_of_half;
    SquareRoot(0.5 + 0.5 * cosine, &cosine_of_half);
    chord = quarter / ((1.0 + cosine) * (1.0 + cosine_of_half));
  }
  SumSeries(kFactors, chords, angles);
  for (size_t i = 0; i < 4; ++i) (*angles)[i] *= chords[i];
}

SOSLAM_IN_WIDE_LOOPS void FindSimilarities(const FourViews& rows, const FourViews& columns,
                                           double factor, Pairs* similarities) {
  Pairs chords{}, angles;
  for (size_t axis = 0; axis < 3; ++axis) {
    for (size_t i = 0; i < 4; ++i) {
      const Four difference = columns.direction[axis] - rows.direction[axis][i];
      chords[i] += difference * difference;
    }
  }
  SquaredAngles(chords, &angles);
  for (Four& angle : angles) angle *= factor;
  Exponential(angles, similarities);
  for (size_t i = 0; i < 4; ++i) (*similarities)[i] *= rows.is_any[i] * columns.is_any;
}

// Each pair once.
SOSLAM_WIDE_LOOPS void AddSimilarities(double correlation_rad, std::vector<FourViews>* views) {
  constexpr double kLeastSquare = 1e-30;  // rad^2, of rounding: its inverse is finite
  const double factor = -0.5 / std::max(kLeastSquare, correlation_rad * correlation_rad);
  for (FourViews& rows : *views) {
    Pairs sums{};
    for (FourViews* columns = views->data(); columns <= &rows; ++columns) {
      Pairs similarities;
      FindSimilarities(rows, *columns, factor, &similarities);
      for (size_t i = 0; i < 4; ++i) sums[i] += similarities[i];
      if (columns == &rows) continue;
      columns->similar_views +=
          (similarities[0] + similarities[1]) + (similarities[2] + similarities[3]);
    }
    for (size_t i = 0; i < 4; ++i) rows.similar_views[i] += Sum(sums[i]);
  }
}

}  // namespace

std::vector<double> ViewWeights(const Sequence& sequence, const std::vector<int>& detections,
                                const Eigen::Vector3d& centre_in_world, double correlation_rad) {
  std::vector<double> weights(detections.size(), 1.0);
  if (!(correlation_rad > 0.0)) return weights;
  std::vector<FourViews> views((detections.size() + 3) / 4);
  for (size_t i = 0; i < detections.size(); ++i) {
    const Detection& detection = sequence.detections[static_cast<size_t>(detections[i])];
    const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
    const Eigen::Vector3d direction =
        (centre_in_world - frame.world_from_camera.translation).normalized();
    for (size_t axis = 0; axis < 3; ++axis) {
      views[i / 4].direction[axis][i % 4] = direction[static_cast<int>(axis)];
    }
    views[i / 4].is_any[i % 4] = 1.0;
  }
  AddSimilarities(correlation_rad, &views);
  for (size_t i = 0; i < weights.size(); ++i) {
    weights[i] = 1.0 / views[i / 4].similar_views[i % 4];
  }
  return weights;
}

}  // namespace soslam
