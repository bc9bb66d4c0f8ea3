// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/semantic_table.h"

#include <set>

namespace soslam {
namespace {

std::optional<ShapePrior> ObjectPrior(const Object& object, const SemanticTable& table,
                                      RatioPrior prior) {
  const std::optional<ShapePrior> entry = table.Find(object.label);
  if (prior == RatioPrior::kTable) return entry;
  ShapePrior shape = entry.value_or(ShapePrior());
  if (prior == RatioPrior::kUnit) {
    shape.ratio.setOnes();
    return shape;
  }
  if (!object.ground_truth) return std::nullopt;
  const Eigen::Vector3d& half_axes = object.ground_truth->landmark_in_world.half_axes;
  shape.ratio = half_axes.head<2>() / half_axes.z();
  shape.log_sigma.setConstant(kTrueRatioLogSigma);
  return shape;
}

}  // namespace

std::optional<ShapePrior> SemanticTable::Find(const std::string& label) const {
  const auto found = priors.find(label);
  return found == priors.end() ? default_prior : found->second;
}

std::vector<std::optional<ShapePrior>> ObjectPriors(const Sequence& sequence,
                                                    const SemanticTable& table, RatioPrior prior,
                                                    ShapeSource shape) {
  std::vector<std::optional<ShapePrior>> priors;
  for (const Object& object : sequence.objects) {
    priors.push_back(ObjectPrior(object, table, prior));
    if (!priors.back() || shape == ShapeSource::kTable) continue;
    priors.back()->shape_exponent =
        shape == ShapeSource::kCuboid ? kCuboidExponent : kEllipsoidExponent;
  }
  return priors;
}

std::vector<std::optional<Eigen::Vector2d>> ObjectRatios(const Sequence& sequence,
                                                         const SemanticTable& table,
                                                         RatioPrior prior) {
  std::vector<std::optional<Eigen::Vector2d>> ratios;
  for (const std::optional<ShapePrior>& shape : ObjectPriors(sequence, table, prior)) {
    ratios.push_back(shape ? std::optional(shape->ratio) : std::nullopt);
  }
  return ratios;
}

std::vector<std::string> LabelsWithoutEntry(const Sequence& sequence, const SemanticTable& table) {
  std::set<std::string> labels;
  for (const Detection& detection : sequence.detections) {
    const std::string& label = sequence.ObjectOf(detection).label;
    if (table.priors.count(label) == 0) labels.insert(label);
  }
  return {labels.begin(), labels.end()};
}

}  // namespace soslam
