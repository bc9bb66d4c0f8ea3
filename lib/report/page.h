// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model/sequence.h"
#include "report/page_parts.h"
#include "report/results_tree.h"

namespace soslam {

// Size of a page with these data.
using BytesOfPage = std::function<size_t(const nlohmann::json& data)>;

// Reduces the data of a dataset's page (see PageData) to at most max_bytes as the page stores them:
// removes the cost over yaw of single observations, then everything but the numbers of variants,
// those of single frames first and maps last, and of sequences when only numbers are left. The
// data's "notes" state what was removed.
void FitPageData(size_t max_bytes, const BytesOfPage& bytes_of, nlohmann::json* data);

// Access to the images of a sequence. The sequence must outlive the source.
using ImageSourceOf = std::function<ImageSource(const Sequence& sequence)>;

// The data of a dataset's page, in at most max_bytes as the page stores them.
//   dataset: its name; url: its folder's
//   images: "data:" URLs by frame id, of the frames that are shown; FramesToShow of the first
//     sequence selects these frames and their detections
//   sequences: see PageSequence; symmetries: curves and descriptors, see PageCurves and
//     PageDescriptors. Variants that share a file share its entry
//   variants: see PageVariant, each with the index of its sequence, of its symmetry or null, and
//     whether there was room for its numbers_only; all variants with readable metrics, in order
//   unfinished: name, state ("failed: ...", "incomplete: ...") and is_shown of variants that
//     differ from the plan, or cannot be shown
//   detailed: see DetailedVariants; findings: see PageFindings
//   has_true_objects, has_true_poses: whether a sequence has the truth of some of its objects, and
//     of some camera's pose
//   notes: sentences on what was left out for lack of room
//   problems: sentences on images that cannot be shown
//   differences: see PageDifferences
//   map_section: see MapSection, of the first map of DetailedVariants; empty without a map. It is
//     part of DatasetTables and need not be stored with the page
nlohmann::json PageData(const DatasetResult& dataset, const ImageSourceOf& images, size_t max_bytes,
                        int threads);

// The data of the page of all datasets: a summary of each dataset's page, and each variant's
// metrics.
nlohmann::json OverviewData(const std::vector<nlohmann::json>& pages);

// "60 frames, 8 objects, 350 detections used" of a dataset's page, by the variant of most interest,
// which is named where others use other detections; empty without variants.
std::string CountsOfDataset(const nlohmann::json& page);

// The part of a page that needs no scripts, as HTML: for a dataset (see PageData) and for all
// datasets (see OverviewData). Texts of the data are escaped.
std::string DatasetTables(const nlohmann::json& page);
std::string OverviewTables(const nlohmann::json& overview);

}  // namespace soslam
