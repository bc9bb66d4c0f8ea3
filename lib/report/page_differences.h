// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "report/results_tree.h"

namespace soslam {

// The effect of each part of the methods, for pairs of neighbouring variants with and without it
// that both have metrics: with, without (names), objects, and for iou, rotation_deg and
// yaw_error_deg the mean paired difference and the ends low and high of its 95 % interval (null for
// fewer than two objects).
nlohmann::json PageDifferences(const DatasetResult& dataset);

}  // namespace soslam
