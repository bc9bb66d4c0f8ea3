// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "model/sequence.h"
#include "report/page_images.h"
#include "report/results_tree.h"

namespace soslam {

// The images of a sequence, which outlives the source.
using ImageSourceOf = std::function<ImageSource(const Sequence& sequence)>;

// All that the page of a dataset shows, in at most max_bytes as the page has it.
//   dataset: its name; url: its folder's
//   images: "data:" URLs by frame id, of frames that are shown; what frames and detections are is
//     selected by FramesToShow of the first sequence
//   sequences: see PageSequence; symmetries: curves and descriptors, see PageCurves and
//     PageDescriptors. Variants of one file share its entry
//   variants: see PageVariant, each with the index of its sequence, of its symmetry or null, and
//     whether there was room for its numbers_only; those with metrics that can be read, in order
//   unfinished: name, state ("failed: ...", "incomplete: ...") and is_shown of variants that are
//     not what was planned, or cannot be shown
//   detailed: see DetailedVariants; findings: see PageFindings
//   notes: sentences on what was left out for lack of room
//   problems: sentences on images that cannot be shown
//   differences: see PageDifferences
nlohmann::json PageData(const DatasetResult& dataset, const ImageSourceOf& images, size_t max_bytes,
                        int threads);

// What the page of all datasets shows: of each what its page says of it, and each variant's
// metrics.
nlohmann::json OverviewData(const std::vector<nlohmann::json>& pages);

}  // namespace soslam
