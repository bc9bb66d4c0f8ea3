// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/dataset_json.h"
#include "dataset/labelled_box.h"
#include "model/finding.h"

namespace soslam {

// Trackers write an id for boxes of no track, too: one below 0, or 0 while real ids begin at 1. Ids
// below 0 are taken for that; 0 where it is of several boxes of one image in at least two images
// (one, when no box has another id), as no other id ever is. Ids that objects.json lists are real.
//
// Returns the boxes with ids. Those that are left out become `left_out`, which is said on stdout
// with the name of the `file`. When no box has an id, all are returned without, which is a finding.
std::vector<LabelledBox> WithoutIdsOfNoTrack(std::vector<LabelledBox> boxes,
                                             const std::vector<ListedObject>& objects,
                                             const std::filesystem::path& file,
                                             std::vector<LabelledBox>* left_out,
                                             std::vector<Finding>* findings);

// Whether any box says which object it is of.
bool HaveObjectIds(const std::vector<LabelledBox>& boxes);

}  // namespace soslam
