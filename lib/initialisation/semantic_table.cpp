// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/semantic_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "base/error.h"

namespace soslam {
namespace {

std::optional<ShapePrior> ObjectPrior(const Object& object, const SemanticTable& table,
                                      RatioPrior prior) {
  std::optional<ShapePrior> entry = table.Find(object.label);
  if (entry) entry = TurnedToSupport(*entry);
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
  shape.log_correlation = 0.0;
  return shape;
}

}  // namespace

ShapePrior TurnedToSupport(const ShapePrior& prior) {
  if (prior.mount != Mount::kOnWall) return prior;
  // Maps (log(a / c), log(b / c)) to (log(c / a), log(b / a)).
  const Eigen::Matrix2d turn{{-1.0, 0.0}, {-1.0, 1.0}};
  const double across = prior.log_correlation * prior.log_sigma.prod();
  const Eigen::Vector2d variances = prior.log_sigma.cwiseAbs2();
  const Eigen::Matrix2d covariance =
      turn * Eigen::Matrix2d{{variances.x(), across}, {across, variances.y()}} * turn.transpose();
  ShapePrior turned = prior;
  turned.ratio = (turn * prior.ratio.array().log().matrix()).array().exp();
  turned.log_sigma = covariance.diagonal().cwiseSqrt();
  turned.log_correlation = covariance(0, 1) / turned.log_sigma.prod();
  if (prior.height_m) {
    turned.height_m = {prior.height_m->median * prior.ratio.x(),
                       std::hypot(prior.height_m->log_sigma, prior.log_sigma.x())};
  }
  return turned;
}

std::string NormalisedLabel(const std::string& label) {
  std::string normalised;
  for (const char character : label) {
    const auto byte = static_cast<unsigned char>(character);
    if (std::isspace(byte) != 0 || character == '_' || character == '-') continue;
    normalised += static_cast<char>(std::tolower(byte));
  }
  return normalised;
}

bool AreSameLabel(const std::string& one, const std::string& other) {
  return NormalisedLabel(one) == NormalisedLabel(other);
}

bool SemanticTable::Contains(const std::string& label) const {
  return priors.count(NormalisedLabel(label)) > 0;
}

std::optional<ShapePrior> SemanticTable::Find(const std::string& label) const {
  const auto found = priors.find(NormalisedLabel(label));
  return found == priors.end() ? default_prior : found->second;
}

SemanticTable LookUpTable(const SemanticRows& rows) {
  SemanticTable table;
  if (rows.default_row) table.default_prior = rows.default_row->prior;
  std::map<std::string, std::string> label_of_name;
  for (const SemanticRow& row : rows.rows) {
    std::vector<std::string> names = row.aliases;
    names.insert(names.begin(), row.label);
    for (const std::string& name : names) {
      const auto [earlier, is_new] = label_of_name.emplace(NormalisedLabel(name), row.label);
      if (!is_new) {
        throw InputError(fmt::format(
            "/labels/{}: name '{}' is that of label '{}' as well (case, blanks, underscores and "
            "hyphens do not count); expected each name once",
            row.label, name, earlier->second));
      }
      table.priors[earlier->first] = row.prior;
    }
  }
  return table;
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
    if (!table.Contains(label)) labels.insert(label);
  }
  return {labels.begin(), labels.end()};
}

}  // namespace soslam
