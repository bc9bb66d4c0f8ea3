// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "model/sequence.h"
#include "model/symmetry_record.h"
#include "report/page_sequence.h"

namespace soslam {

// Cost over yaw of up to kCurvesPerObject observations of each object, evenly spaced among the
// selected ones: detection (index into the selected ones); yaw_deg: the grid; cost: by name;
// true_yaw_deg, initial_yaw_deg, refined_yaw_deg, yaw_sigma_deg or null; pairs: up to kPairsOfCurve
// pixels with their mirror pixels [x, y, x, y].
inline constexpr size_t kCurvesPerObject = 3;
inline constexpr size_t kPairsOfCurve = 120;
nlohmann::json PageCurves(const std::vector<SymmetryRecord>& records, const Sequence& sequence,
                          const PageSelection& selection);

// Accuracy of each cost's yaw modulo half a turn, over all observations with ground truth, by name:
// observations; median_error_deg of its lowest minimum; within: the fraction of them with an error
// of at most 0, kErrorStepDeg, 2 kErrorStepDeg, ... 90 degrees; known_at_truth: the fraction with a
// cost at the true yaw; near_where_known: of those the fraction with an error of at most 10
// degrees, or null; minima: mean number of local minima over half a turn. Empty without ground
// truth.
inline constexpr int kErrorStepDeg = 5;
nlohmann::json PageDescriptors(const std::vector<SymmetryRecord>& records);

}  // namespace soslam
