// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/bound_edges.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "model/occlusion.h"

namespace soslam {
namespace {

// Edges this close to the image border (px) count as cut by it. Tools differ by up to a pixel in
// the position of the border (width - 1 or width), and detectors round.
constexpr double kCutAtBorderPx = 1.5;

// Rounding tolerance: a covered share equal to the option's value counts as occluded.
constexpr double kShareTolerance = 1e-9;

// Share of a box's lower edge that lies inside the union of other boxes.
double CoveredShareOfLowerEdge(const Box& box, const std::vector<Box>& others) {
  std::vector<std::pair<double, double>> intervals;
  for (const Box& other : others) {
    if (box.y_max < other.y_min || box.y_max > other.y_max) continue;
    intervals.emplace_back(std::max(box.x_min, other.x_min), std::min(box.x_max, other.x_max));
  }
  std::sort(intervals.begin(), intervals.end());
  double covered = 0.0;
  double covered_until = -std::numeric_limits<double>::infinity();
  for (const auto& [begin, end] : intervals) {
    covered += std::max(0.0, end - std::max(begin, covered_until));
    covered_until = std::max(covered_until, end);
  }
  return covered / box.Width();
}

}  // namespace

std::array<bool, 4> EdgesCutByBorder(const Box& box, const Camera& camera) {
  return {box.x_min + 0.5 <= kCutAtBorderPx,                 //
          box.y_min + 0.5 <= kCutAtBorderPx,                 //
          camera.width - 0.5 - box.x_max <= kCutAtBorderPx,  //
          camera.height - 0.5 - box.y_max <= kCutAtBorderPx};
}

// Nearer objects make only the lower edge a bound. They stand on the same support, so they occlude
// what is behind them from the base upwards, and a box that ends within another has probably lost
// its base. Sides and tops are less certain: the box of a tall object full of gaps (a chair) covers
// much that is visible past its back and between its legs, and the edge of the object behind is
// then measured as well as any.
void MarkHiddenEdges(const ImportOptions& options, Sequence* sequence) {
  for (Detection& detection : sequence->detections) {
    const double hidden_share =
        CoveredShareOfLowerEdge(detection.box, BoxesInFront(*sequence, detection));
    if (hidden_share >= options.hidden_edge_fraction - kShareTolerance) {
      detection.is_bound[3] = true;
    }
  }
}

}  // namespace soslam
