// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "model/sequence.h"
#include "report/results_tree.h"

namespace soslam {

// What a page shows of one variant with metrics; `sequence` is the one that it has. No
// outlines and curves of frames that are not among `shown` (indices, ascending).
//   name; kind: "map", "views" (one landmark from all frames, without a back end) or "frames" (one
//     for each observation)
//   metrics: metrics.json without its header
//   objects, one per object of the sequence: landmark in the world (of kind "frames" that of its
//     first observation) or null, failure, observations; with a covariance also centre_covariance
//     (3 x 3, m^2), sigma_centre (m), sigma_log_half_axes, sigma_yaw_deg (about the landmark's z)
//   outlines, one per detection: see PageOutline, or null
//   trajectory: poses of the map; solver: iterations, costs, what was used and left out
//   curves, descriptors: see PageCurves and PageDescriptors
nlohmann::json PageVariant(const VariantResult& result, const Sequence& sequence,
                           const std::vector<int>& shown);

}  // namespace soslam
