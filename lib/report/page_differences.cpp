// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_differences.h"

#include <array>
#include <vector>

#include "report/page_json.h"
#include "report/paired_differences.h"

namespace soslam {
namespace {

using nlohmann::json;

// Pairs of variants, of which the first has one more part.
const std::array<Comparison, 10> kParts = {{{"InitP", "Init1-1"},
                                            {"InitPT", "InitP"},
                                            {"InitS", "InitP"},
                                            {"InitST", "InitS"},
                                            {"InitSTE", "InitST"},
                                            {"OursP", "Quadric"},
                                            {"OursPT", "OursP"},
                                            {"OursS", "OursP"},
                                            {"OursST", "OursS"},
                                            {"OursSTE", "OursST"}}};

json PageDifference(const std::vector<double>& differences) {
  json page = {{"mean", nullptr}, {"low", nullptr}, {"high", nullptr}};
  if (differences.empty()) return page;
  const PairedDifference paired = MeanDifference(differences);
  page["mean"] = PageNumber(paired.mean);
  if (paired.confidence_95) {
    page["low"] = PageNumber(paired.confidence_95->low);
    page["high"] = PageNumber(paired.confidence_95->high);
  }
  return page;
}

}  // namespace

json PageDifferences(const DatasetResult& dataset) {
  json pairs = json::array();
  for (const Comparison& parts : kParts) {
    const VariantResult* with = dataset.Evaluated(parts.variant);
    const VariantResult* without = dataset.Evaluated(parts.baseline);
    if (with == nullptr || without == nullptr) continue;
    json pair = {{"with", parts.variant}, {"without", parts.baseline}};
    pair["objects"] = DifferencesByObject(*with, *without, kIou).size();
    for (const Quantity& quantity : {kIou, kRotation, kYawError}) {
      pair[quantity.key] = PageDifference(DifferencesByObject(*with, *without, quantity));
    }
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

}  // namespace soslam
