// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "soslam/association/options.h"
#include "soslam/model/label_groups.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Sum of detection scores, keyed by label.
using LabelVotes = std::map<std::string, double>;

// Label confusion model of the detector: the probability of each name that it gives to an object of
// a label. All labels of a group of interchangeable_labels count as one.
class LabelConfusion {
 public:
  // `labels`: all labels of the detections. Throws SettingsError for malformed groups.
  LabelConfusion(const std::set<std::string>& labels, const AssociateOptions& options);

  // Probability that an object is detected with a label, one of those of the detections, over which
  // it is normalised.
  double Probability(const std::string& of_detection, const std::string& of_object) const;
  // That probability for an object whose label is uncertain.
  double Probability(const std::string& of_detection,
                     const std::vector<LabelProbability>& of_object) const;
  // -2 log of the probability of any label for an unseen object (uniform).
  double CostOfAnyLabel() const;

  // Labels that an object with these votes may have: those voted for, and those similar to them,
  // sorted.
  std::vector<std::string> Candidates(const LabelVotes& votes) const;
  // -log of the probability of the votes for an object of this label. A detector repeats its errors
  // from frame to frame, so all votes together have the weight of one.
  double CostOfVotes(const LabelVotes& votes, const std::string& of_object) const;

 private:
  // Labels that are similar to a label, and the label itself; none where nothing is similar to it.
  std::set<std::string> SimilarTo(const std::string& label) const;
  double ComputeProbability(const std::string& of_detection, const std::string& of_object) const;

  LabelGroups groups_;
  std::vector<std::vector<std::string>> similar_;
  std::set<std::string> detected_groups_;
  double probability_;          // of a label that is neither the object's nor similar to it, in sum
  double similar_probability_;  // of a similar label, in sum
  // Probability by the label of a detection, then that of an object: asked for each pair of boxes.
  std::map<std::string, std::map<std::string, double>> probabilities_;
};

// Probabilities of alternatives whose costs are -log of their evidence, most probable first.
std::vector<LabelProbability> ProbabilitiesOfLabels(const std::map<std::string, double>& costs);

}  // namespace soslam
