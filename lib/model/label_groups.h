// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

namespace soslam {

// Groups of labels from the text of an option, 'a, b; c, d'. Throws SettingsError, naming the
// option, for an empty label.
std::vector<std::vector<std::string>> ParseLabelGroups(const char* option, const std::string& text);

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
