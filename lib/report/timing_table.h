// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/table.h"
#include "report/paper_tables.h"
#include "report/results_tree.h"

namespace soslam {

// Run time per landmark. Single-frame variants: edges, initialisation and refinement, per
// observation; SVD and MultiView: the same, per object; maps: the back end alone, per object.
struct LandmarkTime {
  double wall_ms = 0.0;
  double cpu_ms = 0.0;
  double observations = 0.0;  // mean number per landmark
};

// Counts of a sequence.json.
struct SequenceCounts {
  int observations = 0;
  int objects = 0;  // objects that were observed
};

// Throws InputError for a file that cannot be read or has no detections of objects.
SequenceCounts CountObservations(const std::filesystem::path& sequence_file);

// None without metrics, observations, or the timing of one of these stages.
std::optional<LandmarkTime> TimePerLandmark(const VariantResult& variant,
                                            const SequenceCounts& counts);

// Table V of the paper: datasets by variants, with the published times; without rows when no
// variant has a time. Throws InputError as CountObservations.
Table TimeTable(const std::vector<DatasetResult>& datasets, const Published& published);

}  // namespace soslam
