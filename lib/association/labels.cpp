// SPDX-License-Identifier: BSD-3-Clause
#include "association/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace soslam {
namespace {

// Parts between separators, trimmed of spaces.
std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    const size_t first = part.find_first_not_of(' ');
    parts.push_back(first == std::string::npos
                        ? ""
                        : part.substr(first, part.find_last_not_of(' ') - first + 1));
    begin = end + 1;
  }
  return parts;
}

// Groups of labels from 'a, b; c, d'. Throws SettingsError for an empty label.
std::vector<std::vector<std::string>> GroupsOf(const char* option, const std::string& text) {
  std::vector<std::vector<std::string>> groups;
  if (text.empty()) return groups;
  for (const std::string& group : Split(text, ';')) {
    groups.push_back(Split(group, ','));
    if (std::ranges::find(groups.back(), "") == groups.back().end()) continue;
    throw SettingsError(fmt::format(
        "{} '{}' has '' as a label; expected groups of labels, 'a, b; c, d'", option, text));
  }
  return groups;
}

}  // namespace

std::set<std::string> ListedLabels(const std::string& text) {
  const std::vector<std::string> parts = Split(text, ',');
  return {parts.begin(), parts.end()};
}

LabelConfusion::LabelConfusion(const std::set<std::string>& labels, const AssociateOptions& options)
    : similar_(GroupsOf("similar_labels", options.similar_labels)),
      probability_(options.label_confusion),
      similar_probability_(options.similar_label_confusion) {
  const std::string& interchangeable = options.interchangeable_labels;
  for (const auto& group : GroupsOf("interchangeable_labels", interchangeable)) {
    for (const std::string& label : group) {
      if (groups_.emplace(label, group.front()).second) continue;
      throw SettingsError(fmt::format(
          "interchangeable_labels '{}' has '{}' twice; expected groups of labels, 'a, b; c, d', "
          "each label once",
          interchangeable, label));
    }
  }
  for (const std::string& label : labels) detected_groups_.insert(Group(label));
}

const std::string& LabelConfusion::Group(const std::string& label) const {
  const auto found = groups_.find(label);
  return found == groups_.end() ? label : found->second;
}

std::set<std::string> LabelConfusion::SimilarGroups(const std::string& label) const {
  std::set<std::string> similar;
  for (const auto& group : similar_) {
    if (std::ranges::find(group, label) == group.end()) continue;
    for (const std::string& other : group) similar.insert(Group(other));
  }
  similar.erase(Group(label));
  return similar;
}

double LabelConfusion::Probability(const std::string& of_detection,
                                   const std::string& of_object) const {
  std::set<std::string> similar;
  if (similar_probability_ > 0.0) similar = SimilarGroups(of_object);
  std::erase_if(similar, [&](const auto& group) { return !detected_groups_.contains(group); });
  const double of_similar = similar.empty() ? 0.0 : similar_probability_;
  if (Group(of_detection) == Group(of_object)) return 1.0 - probability_ - of_similar;
  if (similar.contains(Group(of_detection))) {
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
    if (similar_probability_ == 0.0) continue;
    for (const auto& group : similar_) {
      if (std::ranges::find(group, label) == group.end()) continue;
      candidates.insert(group.begin(), group.end());
    }
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
