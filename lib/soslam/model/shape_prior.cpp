// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/shape_prior.h"

#include <algorithm>
#include <cmath>

namespace soslam {
namespace {

// Covariance of the logarithms of the two ratios.
Eigen::Matrix2d RatioCovariance(const ShapePrior& prior) {
  const double across = prior.log_correlation * prior.log_sigma.prod();
  const Eigen::Vector2d variances = prior.log_sigma.cwiseAbs2();
  return Eigen::Matrix2d{{variances.x(), across}, {across, variances.y()}};
}

void SetRatio(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance, ShapePrior* prior) {
  prior->ratio = mean.array().exp();
  prior->log_sigma = covariance.diagonal().cwiseSqrt();
  prior->log_correlation = covariance(0, 1) / prior->log_sigma.prod();
}

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

std::optional<LengthAlongAxis> ShapePrior::Length() const {
  std::optional<LengthAlongAxis> length = known_length;
  if (!length && height_m) length = {*height_m, 2};
  if (length) length->axis = AxisOfOwn(length->axis, rests_on);
  return length;
}

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
  SetRatio(turn * standing.ratio.array().log().matrix(), covariance, &turned);
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
  if (prior.known_length) {
    turned.known_length->axis = AxisOfOwn(prior.known_length->axis, RestingFace::kBack);
  }
  return turned;
}

ShapePrior TimesRatioLikelihood(const ShapePrior& prior, const Eigen::Vector2d& mean,
                                const Eigen::Vector2d& variance) {
  const Eigen::Matrix2d of_prior = RatioCovariance(prior).inverse();
  const Eigen::Vector2d of_likelihood = variance.cwiseInverse();
  const Eigen::Matrix2d covariance =
      (of_prior + Eigen::Matrix2d(of_likelihood.asDiagonal())).inverse();
  ShapePrior product = prior;
  SetRatio(covariance *
               (of_prior * prior.ratio.array().log().matrix() + of_likelihood.cwiseProduct(mean)),
           covariance, &product);
  return product;
}

ShapePrior WithKnownSize(const ShapePrior& prior, const KnownSize& size) {
  constexpr double kLogSigma = 0.005;
  ShapePrior known = prior;
  // Information on the logarithms of the two ratios and of the height, which is not known.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  information.topLeftCorner<2, 2>() = RatioCovariance(prior).inverse();
  Eigen::Vector3d sum = information.leftCols<2>() * prior.ratio.array().log().matrix();
  const std::array lengths_m = {size.depth_m, size.width_m, size.height_m};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const std::optional<double>& length_m = lengths_m[static_cast<size_t>(axis)];
    if (!length_m) continue;
    Eigen::Vector3d d_log_length = Eigen::Vector3d::UnitZ();
    if (axis < 2) d_log_length[axis] = 1.0;
    information += d_log_length * d_log_length.transpose() / (kLogSigma * kLogSigma);
    sum += d_log_length * std::log(*length_m) / (kLogSigma * kLogSigma);
    known.known_length = {{*length_m, kLogSigma}, axis};
  }
  if (!known.known_length) return prior;
  const Eigen::Matrix3d covariance = information.inverse();
  const Eigen::Vector3d mean = covariance * sum;
  SetRatio(mean.head<2>(), covariance.topLeftCorner<2, 2>(), &known);
  known.height_m = LogNormal{std::exp(mean.z()), std::sqrt(covariance(2, 2))};
  return known;
}

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
  SetRatio(mean, covariance, &mixture);
  for (double* exponent :
       {&mixture.shape_exponents.horizontal, &mixture.shape_exponents.vertical}) {
    *exponent = std::clamp(*exponent, kCuboidExponent, kEllipsoidExponent);  // but for rounding
  }
  mixture.height_m = HeightOfMixture(priors);
  return mixture;
}

}  // namespace soslam
