// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "dataset/dataset_files.h"
#include "dataset/dataset_json.h"
#include "dataset/detection_row.h"
#include "model/sequence.h"

namespace soslam {

// All objects of a dataset, sorted by id: those of objects.json, detected or not, and those that
// only occur in detections, which have no ground truth. An object stands on its support_plane, or
// else on the only plane; on none when no plane is known. Rows of one object have one label. Throws
// InputError for a plane that does not exist, and when the plane is not given although there are
// several.
std::vector<Object> ListObjects(const DatasetFiles& files, const std::vector<ListedObject>& given,
                                const std::vector<DetectionRow>& rows,
                                const std::vector<SupportPlane>& planes);

}  // namespace soslam
