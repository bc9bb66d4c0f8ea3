// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/plane_heights.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace soslam {
namespace {

// Grid steps in either direction from zero tilt.
constexpr int kTiltSteps = 32;

// Height of an object at a given tilt, with its information (1 / m^2).
struct Height {
  double mean;
  double information;
};

// Weighted sums of heights relative to one of them, which avoids cancellation of squares.
struct Sums {
  double weight = 0.0;
  double first = 0.0;
  double second = 0.0;

  void Add(const Height& height, double reference) {
    const double from_reference = height.mean - reference;
    weight += height.information;
    first += height.information * from_reference;
    second += height.information * from_reference * from_reference;
  }
  double Mean() const { return first / weight; }
  double Cost() const { return std::max(0.0, 0.5 * (second - first * first / weight)); }
};

// The partition of heights into levels of least cost. Levels are contiguous in the sorted heights,
// so dynamic programming over the first n heights finds the optimum.
PlaneHeights BestPartition(const std::vector<Height>& heights, double new_level_cost) {
  std::vector<size_t> order(heights.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, {}, [&](size_t i) { return heights[i].mean; });
  std::vector<double> cost(heights.size() + 1);      // least cost of the first n heights
  std::vector<size_t> begin_of(heights.size() + 1);  // first height of the last level of these
  for (size_t end = 1; end <= order.size(); ++end) {
    cost[end] = std::numeric_limits<double>::infinity();
    Sums sums;
    for (size_t begin = end; begin-- > 0;) {
      sums.Add(heights[order[begin]], heights[order[end - 1]].mean);
      const double with_level = cost[begin] + sums.Cost() + new_level_cost;
      if (with_level >= cost[end]) continue;
      cost[end] = with_level;
      begin_of[end] = begin;
    }
  }
  PlaneHeights levels;
  levels.cost = cost.back();
  levels.level_of.resize(order.size());
  std::vector<size_t> ends;
  for (size_t end = order.size(); end > 0; end = begin_of[end]) ends.insert(ends.begin(), end);
  for (size_t level = 0; level < ends.size(); ++level) {
    Sums sums;
    const double reference = heights[order[begin_of[ends[level]]]].mean;
    for (size_t i = begin_of[ends[level]]; i < ends[level]; ++i) {
      sums.Add(heights[order[i]], reference);
      levels.level_of[order[i]] = static_cast<int>(level);
    }
    levels.heights.push_back(reference + sums.Mean());
  }
  return levels;
}

}  // namespace

PlaneEvidence WithHeightNoise(const PlaneEvidence& evidence, double height_sigma) {
  const Eigen::Vector3d d_height = evidence.information.col(2);
  const double variance = height_sigma * height_sigma;
  const double share = variance / (1.0 + variance * d_height.z());
  const double slope = evidence.gradient.z();
  return {evidence.cost - 0.5 * share * slope * slope, evidence.gradient - share * slope * d_height,
          evidence.information - share * d_height * d_height.transpose()};
}

PlaneHeights ClusterPlaneHeights(const std::vector<PlaneEvidence>& evidence,
                                 const std::vector<double>& heights, const PlaneEvidence& prior,
                                 double max_tilt, double new_level_cost) {
  PlaneHeights best;
  best.cost = std::numeric_limits<double>::infinity();
  std::vector<Height> at_tilt(evidence.size());
  const double step = max_tilt / kTiltSteps;
  for (int i = -kTiltSteps; i <= kTiltSteps; ++i) {
    for (int k = -kTiltSteps; k <= kTiltSteps; ++k) {
      const Eigen::Vector2d tilt(i * step, k * step);
      double cost = prior.gradient.head<2>().dot(tilt) +
                    0.5 * tilt.dot(prior.information.topLeftCorner<2, 2>() * tilt);
      for (size_t n = 0; n < evidence.size(); ++n) {
        const Eigen::Vector3d& gradient = evidence[n].gradient;
        const Eigen::Matrix3d& information = evidence[n].information;
        const double slope = gradient(2) + information.row(2).head<2>().dot(tilt);
        cost += gradient.head<2>().dot(tilt) +
                0.5 * tilt.dot(information.topLeftCorner<2, 2>() * tilt) -
                0.5 * slope * slope / information(2, 2);
        // If it shares its plane with no other.
        at_tilt[n] = {heights[n] - slope / information(2, 2), information(2, 2)};
      }
      PlaneHeights levels = BestPartition(at_tilt, new_level_cost);
      levels.tilt = tilt;
      levels.cost += cost;
      if (levels.cost < best.cost) best = std::move(levels);
    }
  }
  return best;
}

}  // namespace soslam
