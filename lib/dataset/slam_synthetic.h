// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "dataset/dataset_content.h"
#include "dataset/import_options.h"

namespace soslam {

// Reads synthetic problems for back ends, one JSON file each, all or those of the option
// `sequences` ("K10N100 K40N200"), as one dataset with a segment per problem:
//   camera               width, height, fx, fy, cx, cy
//   support_plane_world  nx, ny, nz, d
//   objects              true ellipsoids: center, half (axes), yaw about the world's z axis
//   T_wc, init_T_wc      true poses and dead reckoning, world_from_camera, 4 x 4, per frame
//   boxes                frame, object, box [x1, y1, x2, y2]
// A frame's or object's id is 10000 times the index of its file, sorted by name, plus its own
// number; frames are 1 s apart, and all objects have the label "ellipsoid". Throws InputError with
// file and JSON pointer; SettingsError for a problem that does not exist.
DatasetContent ReadSlamSynthetic(const std::filesystem::path& folder, const ImportOptions& options);

}  // namespace soslam
