// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/semantic_table.h"

#include <set>

namespace soslam {
namespace {

std::optional<Eigen::Vector2d> ObjectRatio(const Object& object, const SemanticTable& table,
                                           RatioPrior prior) {
  switch (prior) {
    case RatioPrior::kTable:
      return table.Find(object.label);
    case RatioPrior::kUnit:
      return Eigen::Vector2d::Ones();
    case RatioPrior::kGroundTruth:
      break;
  }
  if (!object.ground_truth) return std::nullopt;
  const Eigen::Vector3d& half_axes = object.ground_truth->landmark_in_world.half_axes;
  return Eigen::Vector2d(half_axes.head<2>() / half_axes.z());
}

}  // namespace

std::optional<Eigen::Vector2d> SemanticTable::Find(const std::string& label) const {
  const auto found = ratios.find(label);
  return found == ratios.end() ? default_ratio : found->second;
}

std::vector<std::optional<Eigen::Vector2d>> ObjectRatios(const Sequence& sequence,
                                                         const SemanticTable& table,
                                                         RatioPrior prior) {
  std::vector<std::optional<Eigen::Vector2d>> ratios;
  for (const Object& object : sequence.objects) {
    ratios.push_back(ObjectRatio(object, table, prior));
  }
  return ratios;
}

std::vector<std::string> LabelsWithoutEntry(const Sequence& sequence, const SemanticTable& table) {
  std::set<std::string> labels;
  for (const Object& object : sequence.objects) {
    if (table.ratios.count(object.label) == 0) labels.insert(object.label);
  }
  return {labels.begin(), labels.end()};
}

}  // namespace soslam
