// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>

namespace soslam {

// Sum of detection scores, keyed by label.
using LabelVotes = std::map<std::string, double>;

// Label with the most votes; the first alphabetically among equals. `votes` must not be empty.
std::string WinningLabel(const LabelVotes& votes);

// Label confusion model of the detector.
class LabelConfusion {
 public:
  // `labels`: all labels of the detector. `probability`: that a detection has another label than
  // its object, uniform over the other labels. `interchangeable`: see AssociateOptions; such labels
  // count as one. Throws SettingsError when it is malformed or has a label twice.
  LabelConfusion(const std::set<std::string>& labels, double probability,
                 const std::string& interchangeable);

  // True if an object of one label may have detections of the other.
  bool AreCompatible(const std::string& one, const std::string& other) const;
  // -2 log of the probability that an object of one label is detected with the other. Infinite when
  // they are not compatible.
  double Cost(const std::string& of_object, const std::string& of_detection) const;
  // -2 log of the probability of any label for an unseen object (uniform).
  double CostOfAnyLabel() const;

 private:
  // Representative of all labels that are interchangeable with this one.
  const std::string& Group(const std::string& label) const;

  std::map<std::string, std::string> groups_;
  double probability_;
  double num_groups_;
};

}  // namespace soslam
