// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "soslam/evaluation/statistics.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/landmark.h"
#include "soslam/report/page_parts.h"

namespace soslam {
namespace {

using nlohmann::json;

json Degrees(const std::optional<double>& radians) {
  return radians ? PageNumber(kDegPerRad * *radians) : json();
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
                {"pairs", json::array()},
                {"pairs_in_all", record.samples.size()}};
  for (const auto& [name, cost] : record.cost) curve["cost"][name] = PageNumbers(cost);
  const size_t all = record.samples.size(), shown = std::min(all, kPairsOfCurve);
  for (size_t i = 0; i < shown; ++i) {
    const size_t k = i * all / shown;
    curve["pairs"].push_back(
        PagePixels({record.samples[k].cast<double>(), record.mirrored[k].cast<double>()}));
  }
  return curve;
}

// Accuracy of one cost over all observations.
struct DescriptorFacts {
  std::vector<double> errors_deg;
  std::vector<double> errors_where_known_deg;  // only those with a cost at the true yaw
  double minima = 0.0;

  // `cost` is NaN in gaps. It is over whole turns, whose ends are neighbours.
  void Add(const std::vector<double>& cost, const SymmetryRecord& record) {
    const auto error_deg = [&](size_t i) {
      return kDegPerRad * std::abs(YawDifferenceModuloPi(record.yaw[i], *record.true_yaw));
    };
    const size_t n = cost.size();
    std::optional<size_t> lowest;
    size_t nearest = 0;  // to the true yaw
    int local_minima = 0;
    for (size_t i = 0; i < n; ++i) {
      if (std::isfinite(cost[i]) && (!lowest || cost[i] < cost[*lowest])) lowest = i;
      if (error_deg(i) < error_deg(nearest)) nearest = i;
      if (cost[i] < cost[(i + 1) % n] && cost[i] <= cost[(i + n - 1) % n]) ++local_minima;
    }
    if (!lowest) return;
    errors_deg.push_back(error_deg(*lowest));
    if (std::isfinite(cost[nearest])) errors_where_known_deg.push_back(errors_deg.back());
    const double turns = (record.yaw.back() - record.yaw.front()) / std::numbers::pi;
    minima += local_minima / std::max(1.0, std::round(turns));
  }
};

// Fraction of the errors within the limit; NaN if there are none.
double ShareWithin(const std::vector<double>& errors_deg, double limit_deg) {
  const auto near =
      std::ranges::count_if(errors_deg, [&](double error_deg) { return error_deg <= limit_deg; });
  return static_cast<double>(near) / static_cast<double>(errors_deg.size());
}

}  // namespace

json PageDescriptors(const std::vector<SymmetryRecord>& records) {
  constexpr double kNearDeg = 10.0;
  std::map<std::string, DescriptorFacts> facts;
  for (const SymmetryRecord& record : records) {
    if (!record.true_yaw) continue;
    for (const auto& [name, cost] : record.cost) facts[name].Add(cost, record);
  }
  json descriptors = json::object();
  for (const auto& [name, of_name] : facts) {
    if (of_name.errors_deg.empty()) continue;
    const auto count = static_cast<double>(of_name.errors_deg.size());
    std::vector<double> within;
    for (int limit_deg = 0; limit_deg <= 90; limit_deg += kErrorStepDeg) {
      within.push_back(ShareWithin(of_name.errors_deg, limit_deg));
    }
    const auto known = static_cast<double>(of_name.errors_where_known_deg.size());
    descriptors[name] = {
        {"observations", of_name.errors_deg.size()},
        {"median_error_deg", PageNumber(*MedianOf(of_name.errors_deg))},
        {"within", PageNumbers(within)},
        {"known_at_truth", PageNumber(known / count)},
        {"near_where_known", PageNumber(ShareWithin(of_name.errors_where_known_deg, kNearDeg))},
        {"minima", PageNumber(of_name.minima / count)}};
  }
  return descriptors;
}

json PageCurves(const std::vector<SymmetryRecord>& records, const Sequence& sequence,
                const PageSelection& selection) {
  std::map<std::pair<int, int>, const SymmetryRecord*> by_ids;
  for (const SymmetryRecord& record : records) {
    by_ids[{record.frame_id, record.object_id}] = &record;
  }
  json curves = json::array();
  for (std::vector<int> detections : DetectionsByObject(sequence)) {
    std::erase_if(detections, [&](int index) {
      return !selection.Shows(sequence.detections[index].frame_index);
    });
    for (const int index : SpreadOver(detections, kCurvesPerObject)) {
      const Detection& detection = sequence.detections[index];
      const auto record =
          by_ids.find({sequence.FrameOf(detection).id, sequence.ObjectOf(detection).id});
      if (record != by_ids.end()) {
        curves.push_back(PageCurve(*record->second, selection.PlaceOfDetection(index)));
      }
    }
  }
  return curves;
}

}  // namespace soslam
