// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "evaluation/statistics.h"
#include "geometry/landmark.h"
#include "report/page_json.h"

namespace soslam {
namespace {

using nlohmann::json;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

json Degrees(double radians) { return PageNumber(kDegPerRad * radians); }

json Degrees(const std::optional<double>& radians) { return radians ? Degrees(*radians) : json(); }

json PagePairs(const SymmetryRecord& record) {
  json pairs = json::array();
  const size_t all = record.samples.size();
  const size_t shown = std::min(all, kPairsOfCurve);
  for (size_t i = 0; i < shown; ++i) {
    const size_t k = i * all / shown;
    pairs.push_back(
        PagePixels({record.samples[k].cast<double>(), record.mirrored[k].cast<double>()}));
  }
  return pairs;
}

json PageCurve(const SymmetryRecord& record, int detection_index) {
  std::vector<double> yaw_deg;
  for (const double yaw : record.yaw) yaw_deg.push_back(kDegPerRad * yaw);
  json curve = {{"detection", detection_index},
                {"yaw_deg", PageNumbers(yaw_deg)},
                {"cost", json::object()},
                {"true_yaw_deg", Degrees(record.true_yaw)},
                {"initial_yaw_deg", Degrees(record.initial_yaw)},
                {"refined_yaw_deg", Degrees(record.refined_yaw)},
                {"yaw_sigma_deg", Degrees(record.yaw_sigma)},
                {"pairs", PagePairs(record)},
                {"pairs_in_all", record.samples.size()}};
  for (const auto& [name, cost] : record.cost) curve["cost"][name] = PageNumbers(cost);
  return curve;
}

// What one cost says over all observations.
struct DescriptorFacts {
  std::vector<double> errors_deg;
  double minima = 0.0;
};

// Of a curve over a whole turn, whose ends are neighbours; gaps hold no minimum.
int LocalMinima(const std::vector<double>& cost) {
  int minima = 0;
  const size_t n = cost.size();
  for (size_t i = 0; i < n; ++i) {
    minima += cost[i] < cost[(i + 1) % n] && cost[i] <= cost[(i + n - 1) % n] ? 1 : 0;
  }
  return minima;
}

void AddRecord(const SymmetryRecord& record, std::map<std::string, DescriptorFacts>* facts) {
  for (const auto& [name, cost] : record.cost) {
    size_t lowest = cost.size();
    for (size_t i = 0; i < cost.size(); ++i) {
      if (std::isfinite(cost[i]) && (lowest == cost.size() || cost[i] < cost[lowest])) lowest = i;
    }
    if (lowest == cost.size()) continue;
    DescriptorFacts& of_name = (*facts)[name];
    of_name.errors_deg.push_back(
        kDegPerRad * std::abs(YawDifferenceModuloPi(record.yaw[lowest], *record.true_yaw)));
    const double turns = (record.yaw.back() - record.yaw.front()) / std::numbers::pi;
    of_name.minima += LocalMinima(cost) / std::max(1.0, std::round(turns));
  }
}

}  // namespace

json PageDescriptors(const std::vector<SymmetryRecord>& records) {
  constexpr double kNearDeg = 10.0;
  std::map<std::string, DescriptorFacts> facts;
  for (const SymmetryRecord& record : records) {
    if (record.true_yaw) AddRecord(record, &facts);
  }
  json descriptors = json::object();
  for (const auto& [name, of_name] : facts) {
    const auto count = static_cast<double>(of_name.errors_deg.size());
    const auto near =
        std::ranges::count_if(of_name.errors_deg, [](double error) { return error <= kNearDeg; });
    descriptors[name] = {{"observations", of_name.errors_deg.size()},
                         {"median_error_deg", PageNumber(*MedianOf(of_name.errors_deg))},
                         {"within_10_deg", PageNumber(static_cast<double>(near) / count)},
                         {"minima", PageNumber(of_name.minima / count)}};
  }
  return descriptors;
}

json PageCurves(const std::vector<SymmetryRecord>& records, const Sequence& sequence,
                const std::vector<int>& shown) {
  std::map<std::pair<int, int>, const SymmetryRecord*> by_ids;
  for (const SymmetryRecord& record : records) {
    by_ids[{record.frame_id, record.object_id}] = &record;
  }
  json curves = json::array();
  for (std::vector<int> detections : DetectionsByObject(sequence)) {
    std::erase_if(detections, [&](int index) {
      const Detection& detection = sequence.detections[static_cast<size_t>(index)];
      return !std::ranges::binary_search(shown, detection.frame_index);
    });
    for (const int index : SpreadOver(detections, kCurvesPerObject)) {
      const Detection& detection = sequence.detections[static_cast<size_t>(index)];
      const auto record =
          by_ids.find({sequence.FrameOf(detection).id, sequence.ObjectOf(detection).id});
      if (record != by_ids.end()) curves.push_back(PageCurve(*record->second, index));
    }
  }
  return curves;
}

}  // namespace soslam
