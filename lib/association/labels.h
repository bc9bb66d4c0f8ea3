// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>

namespace soslam {

// Sum of scores by label.
using LabelVotes = std::map<std::string, double>;

// The label with the most votes, of equals the first in the alphabet. `votes` are not empty.
std::string WinningLabel(const LabelVotes& votes);

// How detectors confuse labels.
class LabelConfusion {
 public:
  // `labels`: all that the detector gives. `probability`: of another label than the object's, any
  // of them alike. `interchangeable`: see AssociateOptions; such labels count as one. Throws
  // SettingsError when it is malformed or has a label twice.
  LabelConfusion(const std::set<std::string>& labels, double probability,
                 const std::string& interchangeable);

  // Whether an object of one label may have detections of the other, at all.
  bool AreCompatible(const std::string& one, const std::string& other) const;
  // -2 log of the probability that an object of a label is detected with this one. Infinite when
  // they are not compatible.
  double Cost(const std::string& of_object, const std::string& of_detection) const;
  // -2 log of the probability of a label, of an object that nothing is known of.
  double CostOfAnyLabel() const;

 private:
  // Stands for all labels that are interchangeable with this one.
  const std::string& Group(const std::string& label) const;

  std::map<std::string, std::string> groups_;
  double probability_;
  double num_groups_;
};

}  // namespace soslam
