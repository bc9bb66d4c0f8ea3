// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/label_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "soslam/base/error.h"
#include "soslam/base/text.h"

namespace soslam {

std::vector<std::vector<std::string>> ParseLabelGroups(const char* option,
                                                       const std::string& text) {
  std::vector<std::vector<std::string>> groups;
  if (text.empty()) return groups;
  for (const std::string_view group : SplitFields(text, ';')) {
    const auto labels = SplitFields(group);
    groups.emplace_back(labels.begin(), labels.end());
    if (std::ranges::find(groups.back(), "") == groups.back().end()) continue;
    throw SettingsError(fmt::format(
        "{} '{}' has '' as a label; expected groups of labels, 'a, b; c, d'", option, text));
  }
  return groups;
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

std::set<std::string> NormalisedLabels(const char* option, const std::string& text) {
  std::set<std::string> labels;
  for (const auto& group : ParseLabelGroups(option, text)) {
    for (const std::string& label : group) labels.insert(NormalisedLabel(label));
  }
  return labels;
}

std::string LabelInWords(const Object& object) {
  const auto is_own = [&](const LabelProbability& label) { return label.label == object.label; };
  if (std::ranges::all_of(object.labels, is_own)) return object.label;
  std::vector<std::string> others;
  double own = 0.0;
  for (const auto& [label, probability] : object.labels) {
    if (label == object.label)
      own = probability;
    else
      others.push_back(fmt::format("{} {:.0f} %", label, 100.0 * probability));
  }
  return fmt::format("{} ({:.0f} %; {})", object.label, 100.0 * own, fmt::join(others, ", "));
}

LabelGroups::LabelGroups(const std::string& interchangeable) {
  for (const auto& group : ParseLabelGroups("interchangeable_labels", interchangeable)) {
    for (const std::string& label : group) {
      if (groups_.emplace(label, group.front()).second) continue;
      throw SettingsError(fmt::format(
          "interchangeable_labels '{}' has '{}' twice; expected groups of labels, 'a, b; c, d', "
          "each label once",
          interchangeable, label));
    }
  }
}

const std::string& LabelGroups::Group(const std::string& label) const {
  const auto found = groups_.find(label);
  return found == groups_.end() ? label : found->second;
}

}  // namespace soslam
