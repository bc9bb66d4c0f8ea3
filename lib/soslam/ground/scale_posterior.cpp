// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/ground/scale_posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

namespace soslam {
namespace {

// Density of the log scale by an object of wrong height: uniform over a factor of about 50.
constexpr double kWrongDensity = 0.25;
constexpr double kGridStep = 0.002;
constexpr double kReach = 4.0;           // standard deviations beyond the outermost hypotheses
constexpr double kNegligible = 0.02;     // probability of hypotheses that do not extend the grid
constexpr double kSpreadKnowledge = 10;  // objects that the stated standard deviations count for

double NormalDensity(double deviation, double sigma) {
  const double z = deviation / sigma;
  return std::exp(-0.5 * z * z) / (sigma * std::sqrt(2.0 * std::numbers::pi));
}

double Density(const ScaleEvidence& object, double log_scale) {
  double density = 0.0;
  for (const ScaleHypothesis& one : object.hypotheses) {
    density += one.probability * NormalDensity(log_scale - one.log_scale, one.log_sigma);
  }
  return (1.0 - object.wrong_probability) * density + object.wrong_probability * kWrongDensity;
}

// Factor on the variance: the mean squared deviation of the objects, with a prior of 1 that has the
// weight of kSpreadKnowledge objects; at least 1.
double EstimateMisfit(const std::vector<ScaleEvidence>& objects, double log_scale) {
  double squares = 0.0;
  double count = -1.0;  // one degree of freedom is the scale's
  for (const ScaleEvidence& object : objects) {
    const auto shares = HypothesisProbabilities(object, log_scale);
    for (size_t i = 0; i < shares.size(); ++i) {
      const ScaleHypothesis& one = object.hypotheses[i];
      const double z = (log_scale - one.log_scale) / one.log_sigma;
      squares += object.weight * shares[i] * z * z;
      count += object.weight * shares[i];
    }
  }
  if (!(count > 0.0)) return 1.0;
  return std::max(1.0, (kSpreadKnowledge + squares) / (kSpreadKnowledge + count));
}

// Moments and quantiles of probabilities on the grid.
ScalePosterior Summary(double low, const std::vector<double>& probabilities) {
  ScalePosterior posterior;
  double mean = 0.0, square = 0.0, sum = 0.0;
  const std::array quantiles = {std::pair(0.025, &posterior.low),
                                std::pair(0.5, &posterior.log_scale),
                                std::pair(0.975, &posterior.high)};
  for (size_t i = 0; i < probabilities.size(); ++i) {
    const double x = low + kGridStep * static_cast<double>(i);
    mean += probabilities[i] * x;
    square += probabilities[i] * x * x;
    for (const auto& [share, value] : quantiles) {
      if (sum >= share || sum + probabilities[i] < share) continue;
      *value = x + kGridStep * ((share - sum) / probabilities[i] - 0.5);
    }
    sum += probabilities[i];
  }
  posterior.log_sigma = std::sqrt(std::max(0.0, square - mean * mean));
  posterior.trusted = 0.0;
  for (size_t i = 0; i < probabilities.size(); ++i) {
    const double x = low + kGridStep * static_cast<double>(i);
    const bool is_near = std::abs(x - posterior.log_scale) < std::log(kTrustedScale);
    posterior.trusted += is_near ? probabilities[i] : 0.0;
  }
  posterior.trusted = std::min(1.0, posterior.trusted);
  return posterior;
}

// Probability of the grid's part beyond the valleys around its highest value.
double ShareOfOtherModes(const std::vector<double>& probabilities) {
  constexpr double kValley = 0.1;  // of the lower one of two modes
  const auto best = std::ranges::max_element(probabilities);
  double share = 0.0;
  const auto add = [&](auto begin, auto end) {
    double lowest = *best, beyond = 0.0, highest = 0.0;
    for (auto i = begin; i != end; ++i) {
      if (*i < lowest) {
        lowest = *i;
        beyond = highest = 0.0;
      } else {
        highest = std::max(highest, *i);
        beyond += *i;
      }
      if (lowest < kValley * highest) share = std::max(share, beyond);
    }
  };
  add(best, probabilities.end());
  add(std::make_reverse_iterator(best), probabilities.rend());
  return share;
}

}  // namespace

std::vector<double> HypothesisProbabilities(const ScaleEvidence& object, double log_scale) {
  const double right = 1.0 - object.wrong_probability;
  const double sum = Density(object, log_scale);
  std::vector<double> shares;
  for (const ScaleHypothesis& one : object.hypotheses) {
    shares.push_back(right * one.probability *
                     NormalDensity(log_scale - one.log_scale, one.log_sigma) / sum);
  }
  return shares;
}

std::optional<ScalePosterior> EstimateScale(const std::vector<ScaleEvidence>& objects,
                                            const std::vector<KnownScale>& known) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto extend = [&](double log_scale, double log_sigma) {
    low = std::min(low, log_scale - kReach * log_sigma);
    high = std::max(high, log_scale + kReach * log_sigma);
  };
  for (const ScaleEvidence& object : objects) {
    for (const ScaleHypothesis& one : object.hypotheses) {
      if (one.probability >= kNegligible) extend(one.log_scale, one.log_sigma);
    }
  }
  for (const KnownScale& one : known) extend(one.log_scale, one.log_sigma);
  if (!(high > low)) return std::nullopt;
  std::vector<double> logs(static_cast<size_t>((high - low) / kGridStep) + 1);
  std::vector<std::vector<double>> logs_of_objects(objects.size(),
                                                   std::vector<double>(logs.size()));
  for (size_t i = 0; i < logs.size(); ++i) {
    const double x = low + kGridStep * static_cast<double>(i);
    for (size_t k = 0; k < objects.size(); ++k) {
      logs_of_objects[k][i] = objects[k].weight * std::log(Density(objects[k], x));
      logs[i] += logs_of_objects[k][i];
    }
    for (const KnownScale& one : known) {
      const double z = (x - one.log_scale) / one.log_sigma;
      logs[i] -= 0.5 * z * z;
    }
  }
  const double mode =
      low + kGridStep * static_cast<double>(std::ranges::max_element(logs) - logs.begin());
  const double misfit = EstimateMisfit(objects, mode);
  const auto normalise = [&](std::vector<double> values) {
    const double highest = std::ranges::max(values);
    for (double& value : values) value = std::exp((value - highest) / misfit);
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    for (double& value : values) value /= sum;
    return values;
  };
  const std::vector<double> probabilities = normalise(logs);
  ScalePosterior posterior = Summary(low, probabilities);
  posterior.misfit = misfit;
  posterior.second_mode_share = ShareOfOtherModes(probabilities);
  for (const std::vector<double>& own : logs_of_objects) {
    std::vector<double> others(logs.size());
    std::ranges::transform(logs, own, others.begin(), std::minus());
    posterior.pull.emplace_back();
    if (objects.size() + known.size() == 1) continue;
    posterior.pull.back() = posterior.log_scale - Summary(low, normalise(others)).log_scale;
  }
  for (const ScaleEvidence& object : objects) {
    const auto shares = HypothesisProbabilities(object, posterior.log_scale);
    posterior.agreement.push_back(std::accumulate(shares.begin(), shares.end(), 0.0));
  }
  return posterior;
}

void WeightSameLabels(double correlation, std::vector<ScaleEvidence>* objects) {
  std::map<std::string, double> count;
  for (const ScaleEvidence& object : *objects) {
    for (const ScaleHypothesis& one : object.hypotheses) count[one.label] += one.probability;
  }
  for (ScaleEvidence& object : *objects) {
    double others = 0.0;
    for (const ScaleHypothesis& one : object.hypotheses) {
      others += one.probability * std::max(0.0, count[one.label] - 1.0);
    }
    object.weight = 1.0 / (1.0 + correlation * others);
  }
}

}  // namespace soslam
