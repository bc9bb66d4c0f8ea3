// SPDX-License-Identifier: BSD-3-Clause
#include "association/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

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

}  // namespace

std::string WinningLabel(const LabelVotes& votes) {
  return std::max_element(
             votes.begin(), votes.end(),
             [](const auto& one, const auto& other) { return one.second < other.second; })
      ->first;
}

LabelConfusion::LabelConfusion(const std::set<std::string>& labels, double probability,
                               const std::string& interchangeable)
    : probability_(probability) {
  if (!interchangeable.empty()) {
    for (const std::string& group : Split(interchangeable, ';')) {
      const std::vector<std::string> members = Split(group, ',');
      for (const std::string& label : members) {
        if (label.empty() || !groups_.emplace(label, members.front()).second) {
          throw SettingsError(fmt::format(
              "interchangeable_labels '{}' has '{}' {}; expected groups of labels, 'a, b; c, d', "
              "each label once",
              interchangeable, label, label.empty() ? "as a label" : "twice"));
        }
      }
    }
  }
  std::set<std::string> different;
  for (const std::string& label : labels) different.insert(Group(label));
  num_groups_ = std::max<double>(1.0, static_cast<double>(different.size()));
}

const std::string& LabelConfusion::Group(const std::string& label) const {
  const auto found = groups_.find(label);
  return found == groups_.end() ? label : found->second;
}

bool LabelConfusion::AreCompatible(const std::string& one, const std::string& other) const {
  return probability_ > 0.0 || Group(one) == Group(other);
}

double LabelConfusion::Cost(const std::string& of_object, const std::string& of_detection) const {
  if (!AreCompatible(of_object, of_detection)) return std::numeric_limits<double>::infinity();
  const bool same = Group(of_object) == Group(of_detection);
  return -2.0 * std::log(same ? 1.0 - probability_ : probability_ / (num_groups_ - 1.0));
}

double LabelConfusion::CostOfAnyLabel() const { return 2.0 * std::log(num_groups_); }

}  // namespace soslam
