// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "soslam/model/world.h"

namespace soslam {

// Scale by one interpretation of an object: its label, and what it stands on.
struct ScaleHypothesis {
  std::string label;
  int plane = 0;             // index of a plane, or kNoPlane of model/sequence.h: at a free height
  double log_scale = 0.0;    // logarithm of metres per unit of the world
  double log_sigma = 1.0;    // of the label's prior and the object's measured height
  double probability = 1.0;  // before the scale is known
};

// Evidence of one object; the probabilities of its hypotheses have the sum 1.
struct ScaleEvidence {
  std::vector<ScaleHypothesis> hypotheses;
  double weight = 1.0;              // below 1 where other objects have correlated heights
  double wrong_probability = 0.05;  // that its height says nothing
};

// Direct knowledge of the logarithm of the scale.
struct KnownScale {
  double log_scale;
  double log_sigma;
  std::string setting = {};  // the option that gives it, or kSizeByHand
};

// Probability distribution of the logarithm of the scale.
struct ScalePosterior {
  double log_scale = 0.0;  // median
  double log_sigma = 0.0;
  double low = 0.0, high = 0.0;    // interval of 95 %
  double misfit = 1.0;             // factor by which the objects' spread widens the distribution
  double second_mode_share = 0.0;  // probability of scales that differ by more than a mode's width
  double trusted = 1.0;            // probability that it is within a factor of kTrustedScale
  std::vector<double> agreement = {};  // per object, the probability that its height is right
  // Per object, by how much it raises log_scale; none where nothing else tells the scale.
  std::vector<std::optional<double>> pull = {};
};

// Bayesian estimate: the height of each object is right under one of its hypotheses, or it says
// nothing. If the objects contradict one another more than their standard deviations allow, the
// distribution is widened. None without any evidence.
std::optional<ScalePosterior> EstimateScale(const std::vector<ScaleEvidence>& objects,
                                            const std::vector<KnownScale>& known);

// Posterior probabilities of an object's hypotheses at a scale; the rest is that of a wrong height.
std::vector<double> HypothesisProbabilities(const ScaleEvidence& object, double log_scale);

// Weights of objects whose heights are correlated because they have the same label.
void WeightSameLabels(double correlation, std::vector<ScaleEvidence>* objects);

}  // namespace soslam
