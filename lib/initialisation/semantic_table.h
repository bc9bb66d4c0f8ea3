// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// SemTable of eq. (11): the size ratio (a / c, b / c) of a label.
struct SemanticTable {
  std::map<std::string, Eigen::Vector2d> ratios;
  std::optional<Eigen::Vector2d> default_ratio;  // for labels that are not in the table

  // None when neither the label nor a default is there.
  std::optional<Eigen::Vector2d> Find(const std::string& label) const;
};

// Where an object's ratio comes from.
enum class RatioPrior {
  kTable,        // its label's entry in the semantic table
  kUnit,         // 1:1:1
  kGroundTruth,  // its own true ratio, to separate the prior's error from the method's
};
inline constexpr std::array kRatioPriorNames = {"table", "unit", "groundtruth"};

// The ratio of each object of the sequence; none where the prior has none.
std::vector<std::optional<Eigen::Vector2d>> ObjectRatios(const Sequence& sequence,
                                                         const SemanticTable& table,
                                                         RatioPrior prior);

// Labels of the sequence's objects that are not in the table, sorted.
std::vector<std::string> LabelsWithoutEntry(const Sequence& sequence, const SemanticTable& table);

}  // namespace soslam
