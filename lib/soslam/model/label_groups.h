// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "soslam/model/sequence.h"

namespace soslam {

// Groups of labels from the text of an option, 'a, b; c, d'. Throws SettingsError, naming the
// option, for an empty label.
std::vector<std::vector<std::string>> ParseLabelGroups(const char* option, const std::string& text);

// Lower case, without blanks, underscores and hyphens: "DiningTable" and "dining_table" are the
// same label.
std::string NormalisedLabel(const std::string& label);
bool AreSameLabel(const std::string& one, const std::string& other);

// The labels of all groups of an option's text, normalised. Throws as ParseLabelGroups.
std::set<std::string> NormalisedLabels(const char* option, const std::string& text);

// The label of an object; "chair (60 %; armchair 40 %)" where it is uncertain.
std::string LabelInWords(const Object& object);

// Labels that count as the same.
class LabelGroups {
 public:
  // `interchangeable` is the text of the option interchangeable_labels. Throws SettingsError when
  // it is malformed or has a label twice.
  explicit LabelGroups(const std::string& interchangeable);

  // Representative of all labels that are interchangeable with this one.
  const std::string& Group(const std::string& label) const;

 private:
  std::map<std::string, std::string> groups_;
};

}  // namespace soslam
