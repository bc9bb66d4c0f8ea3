// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "report/results_tree.h"

namespace soslam {

// What each part of the methods is worth: for pairs of neighbouring variants with and without it
// that both have metrics: with, without (names), objects, and of iou, rotation_deg and
// yaw_error_deg the mean paired difference and the ends low and high of its 95 % interval (null of
// fewer than two objects).
nlohmann::json PageDifferences(const DatasetResult& dataset);

}  // namespace soslam
