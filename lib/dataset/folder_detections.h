// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dataset/dataset_content.h"
#include "dataset/dataset_files.h"
#include "dataset/import_options.h"
#include "dataset/labelled_box.h"
#include "dataset/tum_list.h"
#include "geometry/distortion.h"

namespace soslam {

// Boxes, and the class names by which they got their labels; none where they name these themselves.
struct FolderBoxes {
  std::vector<LabelledBox> boxes;
  std::vector<std::string> class_names;
};

// The boxes of a folder of images, in any of the formats of `detections_format`. The class names of
// YOLO's labels may lie with them: `files` then gets to know where, and it is said on stdout. Boxes
// that are not as they stand in the file are counted in `mended`. Throws InputError.
FolderBoxes ReadFolderBoxes(const std::filesystem::path& folder, const ImportOptions& options,
                            const Camera& camera, DatasetFiles* files, RejectionCounts* mended);

// The boxes as rows of these images. Boxes without object ids are of an object each, with ids from
// `first_free_id` on. Boxes of images that are not listed are counted in `rejected`, and how many
// these are is said on stdout. Throws InputError for a row number beyond the list, and when no box
// is of a listed image.
std::vector<DetectionRow> RowsOfBoxes(const std::vector<LabelledBox>& boxes,
                                      const DatasetFiles& files,
                                      const std::vector<ListedImage>& images, int first_free_id,
                                      RejectionCounts* rejected);

// The boxes of listed images as rows of no object.
std::vector<DetectionRow> RowsWithoutObject(const std::vector<LabelledBox>& boxes,
                                            const std::vector<ListedImage>& images);

// Turns boxes in images that a lens took into those of a pinhole camera (UndistortBox). Boxes
// without such a counterpart are counted in `rejected`.
std::vector<DetectionRow> Undistorted(std::vector<DetectionRow> rows, const Camera& camera,
                                      const Distortion& distortion, RejectionCounts* rejected);

}  // namespace soslam
