// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/dataset_files.h"
#include "dataset/dataset_json.h"
#include "dataset/gate.h"
#include "dataset/labelled_box.h"
#include "model/finding.h"
#include "model/sequence.h"

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

// Gives all rows of an object one label, as detectors use several labels for one object: the most
// frequent one (ties: larger sum of scores, then alphabetical), or that of objects.json unless more
// than half of the rows have another. Returns the number of rows whose label changed. Throws
// InputError, naming a row, for an object whose label in objects.json differs from that of most
// rows.
int UnifyLabels(const std::vector<ListedObject>& objects, std::vector<DetectionRow>* rows);

// All objects of a dataset, sorted by id: those of objects.json, detected or not, and those that
// only occur in detections, which have no ground truth. An object stands on its support_plane, or
// else on the only plane. Where there are several, the plane of a row without object id is unknown;
// an object with an id must say its plane. Rows of one object have one label. Throws InputError for
// a plane that does not exist or is not given.
std::vector<Object> ListObjects(const DatasetFiles& files, const std::vector<ListedObject>& given,
                                const std::vector<DetectionRow>& rows,
                                const std::vector<SupportPlane>& planes, bool has_object_ids);

}  // namespace soslam
