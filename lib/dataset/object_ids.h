// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/dataset_json.h"
#include "dataset/labelled_box.h"
#include "model/finding.h"

namespace soslam {

// Separates boxes without a track, for which trackers may write an id, too: one below 0, or 0 while
// real ids begin at 1. Ids below 0 mean no track; so does 0 if several boxes of one image have it
// in at least two images (one, when no box has another id), as real ids are unique per image. Ids
// listed in objects.json are real.
//
// Returns the boxes with ids. Boxes without a track become `left_out`; their number is printed to
// stdout with the name of the `file`. When no box has an id, all are returned without ids, which is
// a finding.
std::vector<LabelledBox> WithoutIdsOfNoTrack(std::vector<LabelledBox> boxes,
                                             const std::vector<ListedObject>& objects,
                                             const std::filesystem::path& file,
                                             std::vector<LabelledBox>* left_out,
                                             std::vector<Finding>* findings);

// True if any box has an object id.
bool HaveObjectIds(const std::vector<LabelledBox>& boxes);

}  // namespace soslam
