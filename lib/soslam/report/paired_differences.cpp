// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "soslam/base/error.h"
#include "soslam/base/text.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/report/tables.h"

namespace soslam {
namespace {

// The probability that the absolute value of a Student variable is below t = sqrt(dof) tan(theta):
// finite series, Abramowitz and Stegun 26.7.3 and 26.7.4.
double StudentProbability(int dof, double theta) {
  const double cosine = std::cos(theta);
  const bool is_odd = dof % 2 == 1;
  const int first = is_odd ? 1 : 0;
  double term = is_odd ? cosine : 1.0;
  double sum = 0.0;
  for (int k = first; k <= dof - 2; k += 2) {
    if (k > first) term *= (k - 1.0) / k * cosine * cosine;
    sum += term;
  }
  const double probability = std::sin(theta) * sum;
  return is_odd ? 2.0 / std::numbers::pi * (theta + probability) : probability;
}

std::string Signed(double value, const Metric& metric) {
  return fmt::format("{:+.{}f}", value, metric.decimals);
}

// Differences of the objects for which both variants have the metric.
std::vector<double> DifferencesByObject(const VariantResult& variant, const VariantResult& baseline,
                                        const ObjectMetric& metric) {
  const std::map<int, double> baseline_values = ObjectValues(baseline, metric);
  std::vector<double> differences;
  for (const auto& [object, value] : ObjectValues(variant, metric)) {
    const auto other = baseline_values.find(object);
    if (other != baseline_values.end()) differences.push_back(value - other->second);
  }
  return differences;
}

}  // namespace

std::vector<Comparison> ParseComparisons(const std::string& lists) {
  std::vector<Comparison> comparisons;
  std::istringstream list_stream(lists);
  for (std::string list; std::getline(list_stream, list, ',');) {
    std::vector<std::string> variants;
    for (const std::string_view word : SplitWords(list)) variants.emplace_back(word);
    if (variants.size() < 2) {
      throw SettingsError(fmt::format("compare: found '{}'; expected two or more variants", list));
    }
    for (size_t i = 1; i < variants.size(); ++i) {
      for (size_t j = 0; j < i; ++j) comparisons.push_back({variants[i], variants[j]});
    }
  }
  return comparisons;
}

double StudentT95(int degrees_of_freedom) {
  // Bisection in the angle theta, in which the probability grows from 0 to 1.
  double low = 0.0;
  double high = std::numbers::pi / 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (StudentProbability(degrees_of_freedom, middle) < 0.95 ? low : high) = middle;
  }
  return std::sqrt(static_cast<double>(degrees_of_freedom)) * std::tan(low);
}

PairedDifference MeanDifference(const std::vector<double>& differences) {
  const int count = static_cast<int>(differences.size());
  PairedDifference difference = {MeanOf(differences).value(), std::nullopt};
  if (count < 2) return difference;
  double squares = 0.0;
  for (const double d : differences) squares += (d - difference.mean) * (d - difference.mean);
  const double standard_error = std::sqrt(squares / (count - 1) / count);
  const double half_width = StudentT95(count - 1) * standard_error;
  difference.confidence_95 = {difference.mean - half_width, difference.mean + half_width};
  return difference;
}

bool PairedDifference::IsClear() const {
  return confidence_95 && (confidence_95->low > 0.0 || confidence_95->high < 0.0);
}

Cell WithInterval(const PairedDifference& difference, const Metric& metric) {
  const std::string mean = Signed(difference.mean, metric);
  if (!difference.confidence_95) return mean;
  const auto& [low, high] = *difference.confidence_95;
  return {fmt::format("{} ({} to {})", mean, Signed(low, metric), Signed(high, metric)),
          difference.IsClear()};
}

namespace {

// Differences of the objects of a dataset, or of several.
struct Compared {
  std::string name;
  std::vector<double> differences;
  bool is_of_several = false;
};

// The datasets that have objects to compare, then those of them with a detector's boxes together,
// then all of them, each if there are several.
std::vector<Compared> ComparedObjects(const std::vector<DatasetResult>& datasets,
                                      const Comparison& comparison, const ObjectMetric& metric) {
  std::vector<Compared> compared;
  Compared of_detector = {"detector's boxes", {}}, of_all = {"all datasets", {}};
  int datasets_of_detector = 0;
  for (const DatasetResult& dataset : datasets) {
    const VariantResult* const variant = dataset.Evaluated(comparison.variant);
    const VariantResult* const baseline = dataset.Evaluated(comparison.baseline);
    if (!variant || !baseline) continue;
    const std::vector<double> differences = DifferencesByObject(*variant, *baseline, metric);
    if (differences.empty()) continue;
    compared.push_back({dataset.name, differences});
    of_all.differences.insert(of_all.differences.end(), differences.begin(), differences.end());
    if (!dataset.facts.HasDetectorBoxes()) continue;
    of_detector.differences.insert(of_detector.differences.end(), differences.begin(),
                                   differences.end());
    ++datasets_of_detector;
  }
  of_all.is_of_several = compared.size() > 1;
  of_detector.is_of_several = datasets_of_detector > 1;
  for (const Compared& several : {of_detector, of_all}) {
    if (several.is_of_several) compared.push_back(several);
  }
  return compared;
}

}  // namespace

Table DifferencesTable(const std::vector<DatasetResult>& datasets,
                       const std::vector<Comparison>& comparisons, const ObjectMetric& metric) {
  Table table = {std::string("differences_") + metric.name,
                 fmt::format("Paired differences: {} ({} is better)", metric.Header(),
                             metric.more_is_better ? "more" : "less"),
                 {"dataset", "variant", "minus", "objects", "difference", "from", "to"},
                 {},
                 3,
                 {"Mean over objects with 95 % t interval; bold where it excludes 0."}};
  for (const Comparison& comparison : comparisons) {
    for (const Compared& compared : ComparedObjects(datasets, comparison, metric)) {
      const PairedDifference difference = MeanDifference(compared.differences);
      const auto& interval = difference.confidence_95;
      table.rows.push_back({compared.name, comparison.variant, comparison.baseline,
                            std::to_string(compared.differences.size()),
                            Cell(Signed(difference.mean, metric), difference.IsClear()),
                            interval ? Signed(interval->low, metric) : kNoValue,
                            interval ? Signed(interval->high, metric) : kNoValue});
    }
  }
  return table;
}

Table DifferencesOverDatasets(const std::vector<DatasetResult>& datasets,
                              const std::vector<Comparison>& comparisons) {
  Table table = {
      "differences",
      "Paired differences over several datasets",
      {"variant", "minus", "datasets", "objects", kIou.Header(), "with Rot", kRotation.Header()},
      {},
      3,
      {"Mean over objects with 95 % t interval; bold where it excludes 0. More IoU and "
       "less Rot are better."}};
  for (const Comparison& comparison : comparisons) {
    const std::vector<Compared> rotations = ComparedObjects(datasets, comparison, kRotation);
    for (const Compared& ious : ComparedObjects(datasets, comparison, kIou)) {
      if (!ious.is_of_several) continue;
      const auto rotation = std::ranges::find(rotations, ious.name, &Compared::name);
      const bool has_rotation = rotation != rotations.end();
      table.rows.push_back({comparison.variant, comparison.baseline, ious.name,
                            std::to_string(ious.differences.size()),
                            WithInterval(MeanDifference(ious.differences), kIou),
                            std::to_string(has_rotation ? rotation->differences.size() : 0),
                            has_rotation
                                ? WithInterval(MeanDifference(rotation->differences), kRotation)
                                : Cell(kNoValue)});
    }
  }
  return table;
}

std::vector<PartDifference> PartDifferences(const DatasetResult& dataset) {
  // Pairs of variants, of which the first has one more part.
  const std::array<Comparison, 14> kParts = {{{"InitP", "Init1-1"},
                                              {"InitPT", "InitP"},
                                              {"InitS", "InitP"},
                                              {"InitST", "InitS"},
                                              {"InitSP", "InitS"},
                                              {"InitSTE", "InitST"},
                                              {"InitSTEP", "InitSTE"},
                                              {"OursP", "Quadric"},
                                              {"OursPT", "OursP"},
                                              {"OursS", "OursP"},
                                              {"OursST", "OursS"},
                                              {"OursSP", "OursS"},
                                              {"OursSTE", "OursST"},
                                              {"OursSTEP", "OursSTE"}}};
  std::vector<PartDifference> differences;
  for (const Comparison& parts : kParts) {
    const VariantResult* with = dataset.Evaluated(parts.variant);
    const VariantResult* without = dataset.Evaluated(parts.baseline);
    if (with == nullptr || without == nullptr) continue;
    PartDifference difference = {parts, DifferencesByObject(*with, *without, kIou).size(), {}};
    for (const ObjectMetric& metric : kMeanMetrics) {
      const std::vector<double> of_metric = DifferencesByObject(*with, *without, metric);
      difference.of_metrics.emplace_back();
      if (!of_metric.empty()) difference.of_metrics.back() = MeanDifference(of_metric);
    }
    differences.push_back(std::move(difference));
  }
  return differences;
}

}  // namespace soslam
