// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/semantic_table.h"

#include <fmt/format.h>

#include <set>

#include "soslam/base/error.h"
#include "soslam/model/label_groups.h"

namespace soslam {
namespace {

std::optional<ShapePrior> ObjectPrior(const Object& object, const SemanticTable& table,
                                      RatioPrior prior) {
  std::optional<ShapePrior> entry = table.Find(object);
  if (entry) entry = TurnedToSupport(*entry);
  if (prior == RatioPrior::kTable) return entry;
  ShapePrior shape = entry.value_or(ShapePrior());
  if (prior == RatioPrior::kUnit) {
    shape.ratio.setOnes();
    return shape;
  }
  if (!object.ground_truth) return std::nullopt;
  const Landmark& truth = object.ground_truth->landmark_in_world;
  const Eigen::Vector3d half_axes =
      shape.attitude == Attitude::kStanding ? truth.half_axes : InOwnAxes(truth).half_axes;
  shape.ratio = half_axes.head<2>() / half_axes.z();
  shape.log_sigma.setConstant(kTrueRatioLogSigma);
  shape.log_correlation = 0.0;
  return shape;
}

// Prior of the mixture of an object's labels.
std::optional<ShapePrior> OfLabels(const SemanticTable& table, const Object& object) {
  if (object.labels.empty()) return table.Find(object.label);
  std::vector<WeightedPrior> priors;
  double sum = 0.0;
  for (const auto& [label, probability] : object.labels) {
    const auto prior = table.Find(label);
    if (!prior || (!priors.empty() && prior->mount != priors.front().prior.mount)) continue;
    priors.push_back({probability, *prior});
    sum += probability;
  }
  if (priors.empty()) return table.Find(object.label);
  for (WeightedPrior& prior : priors) prior.weight /= sum;
  return MomentsOfMixture(priors);
}

}  // namespace

bool SemanticTable::Contains(const std::string& label) const {
  return priors.count(NormalisedLabel(label)) > 0;
}

std::optional<ShapePrior> SemanticTable::Find(const std::string& label) const {
  const auto found = priors.find(NormalisedLabel(label));
  return found == priors.end() ? default_prior : found->second;
}

std::optional<ShapePrior> SemanticTable::Find(const Object& object) const {
  const auto of_labels = OfLabels(*this, object);
  return of_labels ? std::optional(WithKnownSize(*of_labels, object.known_size)) : std::nullopt;
}

std::map<std::string, size_t> RowsByName(const SemanticRows& rows) {
  std::map<std::string, size_t> row_of_name;
  for (size_t i = 0; i < rows.rows.size(); ++i) {
    const SemanticRow& row = rows.rows[i];
    std::vector<std::string> names = row.aliases;
    names.insert(names.begin(), row.label);
    for (const std::string& name : names) {
      const auto [earlier, is_new] = row_of_name.emplace(NormalisedLabel(name), i);
      if (is_new) continue;
      throw InputError(fmt::format(
          "/labels/{}: name '{}' is that of label '{}' as well (case, blanks, underscores and "
          "hyphens do not count); expected each name once",
          row.label, name, rows.rows[earlier->second].label));
    }
  }
  return row_of_name;
}

SemanticTable LookUpTable(const SemanticRows& rows) {
  SemanticTable table;
  if (rows.default_row) table.default_prior = rows.default_row->prior;
  for (const auto& [name, row] : RowsByName(rows)) table.priors[name] = rows.rows[row].prior;
  return table;
}

std::vector<std::optional<ShapePrior>> ObjectPriors(const Sequence& sequence,
                                                    const SemanticTable& table, RatioPrior prior,
                                                    ShapeSource shape) {
  std::vector<std::optional<ShapePrior>> priors;
  for (const Object& object : sequence.objects) {
    priors.push_back(ObjectPrior(object, table, prior));
    if (!priors.back() || shape == ShapeSource::kTable) continue;
    priors.back()->shape_exponents =
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
    if (!table.Contains(label)) labels.insert(label);
  }
  return {labels.begin(), labels.end()};
}

}  // namespace soslam
