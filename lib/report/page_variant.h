// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "model/sequence.h"
#include "report/page_sequence.h"
#include "report/results_tree.h"

namespace soslam {

// The data of one variant with metrics on a page; `sequence` is the variant's own.
//   name; kind: "map", "views" (one landmark from all frames, without a back end) or "frames" (one
//     for each observation), by the stages that produced it
//   metrics: metrics.json without its header and findings
//   objects, one per object of the sequence: landmark in the world (of kind "frames" that of its
//     first observation) or null, failure, observations; with a covariance also centre_covariance
//     (3 x 3, m^2), sigma_centre (m), sigma_log_half_axes, sigma_yaw_deg (about the landmark's z)
//   outlines, one per detection that is selected: see PageOutline, or null
//   trajectory: poses of the map for the selected frames; solver: iterations, costs, and the counts
//     of residuals used and left out
//   planes: those of the map, see PageGrids, and grids, by selected frame, see PageGridInFrame;
//     both null if they are the sequence's
// Throws InputError when a file that the variant should have is missing or not valid.
nlohmann::json PageVariant(const VariantResult& result, const Sequence& sequence,
                           const PageSelection& selection);

// Variants of a dataset's page that have more than numbers, as indices into its "variants", in the
// order of interest: maps before views before single frames, and of each kind the variant with the
// most parts first.
std::vector<size_t> DetailedVariants(const nlohmann::json& page);

}  // namespace soslam
