// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/semantic_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "model/label_groups.h"

namespace soslam {
namespace {

// Covariance of the logarithms of the two ratios.
Eigen::Matrix2d RatioCovariance(const ShapePrior& prior) {
  const double across = prior.log_correlation * prior.log_sigma.prod();
  const Eigen::Vector2d variances = prior.log_sigma.cwiseAbs2();
  return Eigen::Matrix2d{{variances.x(), across}, {across, variances.y()}};
}

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

}  // namespace

ShapePrior OnFace(const ShapePrior& standing, RestingFace face) {
  ShapePrior turned = standing;
  turned.rests_on = face;
  if (face == RestingFace::kBottom) return turned;
  // The axis of the sections lies down with the body: one exponent between the two stands for both.
  turned.shape_exponents = standing.shape_exponents.Mean();
  // Logarithms of half axes along the object frame by those of (a / c, b / c) and of c.
  Eigen::Matrix<double, 3, 2> by_ratios;
  by_ratios << Eigen::Matrix2d::Identity(), Eigen::RowVector2d::Zero();
  const Eigen::Matrix<double, 3, 2> logs = OwnFromObject(face).cwiseAbs().transpose() * by_ratios;
  const Eigen::Matrix2d turn = logs.topRows<2>().rowwise() - logs.row(2);
  const Eigen::Matrix2d covariance = turn * RatioCovariance(standing) * turn.transpose();
  turned.ratio = (turn * standing.ratio.array().log().matrix()).array().exp();
  turned.log_sigma = covariance.diagonal().cwiseSqrt();
  turned.log_correlation = covariance(0, 1) / turned.log_sigma.prod();
  return turned;
}

std::vector<std::optional<ShapePrior>> OnPossibleFaces(const std::optional<ShapePrior>& standing) {
  if (!standing || standing->attitude == Attitude::kStanding) return {standing};
  std::vector<std::optional<ShapePrior>> priors;
  for (const RestingFace face : kRestingFaces) priors.emplace_back(OnFace(*standing, face));
  return priors;
}

ShapePrior TurnedToSupport(const ShapePrior& prior) {
  if (prior.mount != Mount::kOnWall) return prior;
  ShapePrior turned = OnFace(prior, RestingFace::kBack);
  turned.rests_on = RestingFace::kBottom;  // the side of its mount is where it stands
  if (prior.height_m) {
    turned.height_m = {prior.height_m->median * prior.ratio.x(),
                       std::hypot(prior.height_m->log_sigma, prior.log_sigma.x())};
  }
  return turned;
}

namespace {

// Log-normal with the moments of a mixture; none if no prior has a height.
std::optional<LogNormal> HeightOfMixture(const std::vector<WeightedPrior>& priors) {
  double weight = 0.0;
  double mean = 0.0;
  for (const auto& [share, prior] : priors) {
    if (!prior.height_m) continue;
    weight += share;
    mean += share * std::log(prior.height_m->median);
  }
  if (weight == 0.0) return std::nullopt;
  mean /= weight;
  double variance = 0.0;
  for (const auto& [share, prior] : priors) {
    if (!prior.height_m) continue;
    variance += share / weight *
                (std::pow(std::log(prior.height_m->median) - mean, 2) +
                 std::pow(prior.height_m->log_sigma, 2));
  }
  return LogNormal{std::exp(mean), std::sqrt(variance)};
}

}  // namespace

ShapePrior MomentsOfMixture(const std::vector<WeightedPrior>& priors) {
  ShapePrior mixture = priors.front().prior;
  if (priors.size() == 1) return mixture;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  mixture.shape_exponents = 0.0;
  mixture.edge_bias = {};
  for (const auto& [weight, prior] : priors) {
    mean += weight * prior.ratio.array().log().matrix();
    mixture.shape_exponents.horizontal += weight * prior.shape_exponents.horizontal;
    mixture.shape_exponents.vertical += weight * prior.shape_exponents.vertical;
    for (size_t i = 0; i < mixture.edge_bias.size(); ++i) {
      mixture.edge_bias[i] += weight * prior.edge_bias[i];
    }
  }
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const auto& [weight, prior] : priors) {
    const Eigen::Vector2d apart = prior.ratio.array().log().matrix() - mean;
    covariance += weight * (RatioCovariance(prior) + apart * apart.transpose());
  }
  mixture.ratio = mean.array().exp();
  mixture.log_sigma = covariance.diagonal().cwiseSqrt();
  mixture.log_correlation = covariance(0, 1) / mixture.log_sigma.prod();
  for (double* exponent :
       {&mixture.shape_exponents.horizontal, &mixture.shape_exponents.vertical}) {
    *exponent = std::clamp(*exponent, kCuboidExponent, kEllipsoidExponent);  // but for rounding
  }
  mixture.height_m = HeightOfMixture(priors);
  return mixture;
}

bool SemanticTable::Contains(const std::string& label) const {
  return priors.count(NormalisedLabel(label)) > 0;
}

std::optional<ShapePrior> SemanticTable::Find(const std::string& label) const {
  const auto found = priors.find(NormalisedLabel(label));
  return found == priors.end() ? default_prior : found->second;
}

std::optional<ShapePrior> SemanticTable::Find(const Object& object) const {
  if (object.labels.empty()) return Find(object.label);
  std::vector<WeightedPrior> priors;
  double sum = 0.0;
  for (const auto& [label, probability] : object.labels) {
    const auto prior = Find(label);
    if (!prior || (!priors.empty() && prior->mount != priors.front().prior.mount)) continue;
    priors.push_back({probability, *prior});
    sum += probability;
  }
  if (priors.empty()) return Find(object.label);
  for (WeightedPrior& prior : priors) prior.weight /= sum;
  return MomentsOfMixture(priors);
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
