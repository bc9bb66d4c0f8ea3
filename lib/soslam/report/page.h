// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "soslam/model/sequence.h"
#include "soslam/report/page_html.h"
#include "soslam/report/page_parts.h"
#include "soslam/report/results_tree.h"
#include "soslam/report/tables.h"

namespace soslam {

// A sequence of some variants, and what a page shows of it.
struct ShownSequence {
  Sequence sequence;
  PageSelection selection;
  nlohmann::json data;  // for scripts, see PageSequence
};

// A variant that differs from the plan, or cannot be shown.
struct UnfinishedVariant {
  std::string name;
  std::string state;  // "failed: ...", "incomplete: ..."
  bool is_shown = false;
};

// The page of a dataset.
struct DatasetPage {
  std::string name;                     // the dataset's
  std::deque<ShownSequence> sequences;  // image sources refer to them
  std::vector<PageVariant> variants;    // all with readable metrics, in order
  std::vector<UnfinishedVariant> unfinished;
  std::vector<PageFinding> findings;
  std::vector<PartDifference> differences;
  bool has_true_objects = false, has_true_poses = false;  // in any sequence
  std::vector<std::string> notes;     // sentences on what was left out for lack of room
  std::vector<std::string> problems;  // sentences on what cannot be shown
  // Section of the first map of DetailedVariants, see MapSection; empty without a map.
  std::string map_section;
  std::string boxes_section;  // of the variant of most interest, see BoxesSection
  // For scripts: "data:" URLs by frame id, of the frames that are shown; curves and descriptors,
  // see PageCurves and PageDescriptors. FramesToShow of the first sequence selects these frames.
  nlohmann::json images = nlohmann::json::object();
  nlohmann::json symmetries = nlohmann::json::array();
};

// Size of a page with this content.
using BytesOfPage = std::function<size_t(const DatasetPage& page)>;

// Reduces a page to at most max_bytes: removes the cost over yaw of single observations, then
// everything but the numbers of variants, those of single frames first and maps last, and of
// sequences when only numbers are left. The page's notes state what was removed.
void FitPage(size_t max_bytes, const BytesOfPage& bytes_of, DatasetPage* page);

// Access to the images of a sequence. The sequence must outlive the source.
using ImageSourceOf = std::function<ImageSource(const Sequence& sequence)>;

// The page of a dataset, whose tables and data have at most max_bytes as the page stores them.
DatasetPage MakePage(const DatasetResult& dataset, const ImageSourceOf& images, size_t max_bytes,
                     int threads);

// Variants that have more than numbers, as indices, in the order of interest: maps before views
// before single frames, and of each kind the variant with the most parts first.
std::vector<size_t> DetailedVariants(const DatasetPage& page);

// "60 frames, 8 objects, 350 detections used", by the variant of most interest, which is named
// where others use other detections; empty without variants.
std::string CountsOfDataset(const DatasetPage& page);

// The part of a page that needs no scripts, as HTML: for a dataset and for all datasets. Texts are
// escaped.
std::string DatasetTables(const DatasetPage& page);
std::string OverviewTables(const std::vector<DatasetPage>& pages);

// The data for the scripts of a dataset's page, and those of the page of all datasets for programs:
// each variant's metrics without their rows.
nlohmann::json MakePageData(const DatasetPage& page);
nlohmann::json OverviewData(const std::vector<DatasetPage>& pages);

}  // namespace soslam
