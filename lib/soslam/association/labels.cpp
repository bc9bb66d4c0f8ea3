// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/labels.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace soslam {
LabelConfusion::LabelConfusion(const std::set<std::string>& labels, const AssociateOptions& options)
    : groups_(options.interchangeable_labels),
      similar_(ParseLabelGroups("similar_labels", options.similar_labels)),
      probability_(options.label_confusion),
      similar_probability_(options.similar_label_confusion) {
  for (const std::string& label : labels) detected_groups_.insert(groups_.Group(label));
  std::set<std::string> of_objects = labels;
  for (const std::string& label : labels) of_objects.merge(SimilarTo(label));
  for (const std::string& detected : labels) {
    for (const std::string& label : of_objects) {
      probabilities_[detected][label] = ComputeProbability(detected, label);
    }
  }
}

std::set<std::string> LabelConfusion::SimilarTo(const std::string& label) const {
  std::set<std::string> similar;
  if (similar_probability_ == 0.0) return similar;
  for (const auto& group : similar_) {
    if (std::ranges::find(group, label) == group.end()) continue;
    similar.insert(group.begin(), group.end());
  }
  return similar;
}

double LabelConfusion::Probability(const std::string& of_detection,
                                   const std::string& of_object) const {
  const auto detected = probabilities_.find(of_detection);
  if (detected != probabilities_.end()) {
    const auto known = detected->second.find(of_object);
    if (known != detected->second.end()) return known->second;
  }
  return ComputeProbability(of_detection, of_object);
}

double LabelConfusion::ComputeProbability(const std::string& of_detection,
                                          const std::string& of_object) const {
  const std::string &detected = groups_.Group(of_detection), &own = groups_.Group(of_object);
  std::set<std::string> similar;  // groups
  for (const std::string& label : SimilarTo(of_object)) {
    const std::string& group = groups_.Group(label);
    if (group != own && detected_groups_.contains(group)) similar.insert(group);
  }
  const double of_similar = similar.empty() ? 0.0 : similar_probability_;
  if (detected == own) return 1.0 - probability_ - of_similar;
  if (similar.contains(detected)) {
    return of_similar / static_cast<double>(similar.size());
  }
  const auto others = static_cast<double>(detected_groups_.size() - similar.size());
  return probability_ / std::max(1.0, others - 1.0);
}

double LabelConfusion::Probability(const std::string& of_detection,
                                   const std::vector<LabelProbability>& of_object) const {
  double sum = 0.0;
  for (const auto& [label, probability] : of_object) {
    sum += probability * Probability(of_detection, label);
  }
  return sum;
}

double LabelConfusion::CostOfAnyLabel() const {
  return 2.0 * std::log(std::max<double>(1.0, static_cast<double>(detected_groups_.size())));
}

std::vector<std::string> LabelConfusion::Candidates(const LabelVotes& votes) const {
  std::set<std::string> candidates;
  for (const auto& [label, score] : votes) {
    candidates.insert(label);
    candidates.merge(SimilarTo(label));
  }
  return {candidates.begin(), candidates.end()};
}

double LabelConfusion::CostOfVotes(const LabelVotes& votes, const std::string& of_object) const {
  double sum = 0.0;
  double cost = 0.0;
  for (const auto& [label, score] : votes) {
    sum += score;
    if (score > 0.0) cost -= score * std::log(Probability(label, of_object));
  }
  return sum > 0.0 ? cost / sum : 0.0;
}

std::vector<LabelProbability> ProbabilitiesOfLabels(const std::map<std::string, double>& costs) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& [label, cost] : costs) lowest = std::min(lowest, cost);
  std::vector<LabelProbability> labels;
  double sum = 0.0;
  for (const auto& [label, cost] : costs) {
    labels.push_back({label, std::exp(lowest - cost)});
    sum += labels.back().probability;
  }
  for (LabelProbability& label : labels) label.probability /= sum;
  std::ranges::stable_sort(labels, std::ranges::greater(), &LabelProbability::probability);
  return labels;
}

}  // namespace soslam
