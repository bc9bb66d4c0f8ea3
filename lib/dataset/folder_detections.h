// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "dataset/dataset_content.h"
#include "dataset/dataset_files.h"
#include "dataset/import_options.h"
#include "dataset/labelled_box.h"
#include "dataset/trajectories.h"
#include "geometry/distortion.h"

namespace soslam {

// Boxes and the class names that their labels were taken from; no names where boxes have labels.
struct FolderBoxes {
  std::vector<LabelledBox> boxes;
  std::vector<std::string> class_names;
};

// Reads the boxes of a folder of images in any of the formats of `detections_format`. Class names
// may be stored with YOLO's labels: `files` then gets their path, which is printed to stdout. Boxes
// that are changed on reading are counted in `corrected`. Throws InputError.
FolderBoxes ReadFolderBoxes(const std::filesystem::path& folder, const ImportOptions& options,
                            const Camera& camera, DatasetFiles* files, RejectionCounts* corrected);

// Converts boxes to rows of these images. Each box without object id is a separate object, with ids
// from `first_free_id` on. Boxes of images that are not listed are counted in `rejected`, and their
// number is printed to stdout. Throws InputError for a row number beyond the list, and when no box
// is of a listed image.
std::vector<DetectionRow> RowsOfBoxes(const std::vector<LabelledBox>& boxes,
                                      const DatasetFiles& files,
                                      const std::vector<ListedImage>& images, int first_free_id,
                                      RejectionCounts* rejected);

// Rows of the boxes of listed images, with no object.
std::vector<DetectionRow> RowsWithoutObject(const std::vector<LabelledBox>& boxes,
                                            const std::vector<ListedImage>& images);

// Converts boxes in distorted images to those of a pinhole camera (UndistortBox). Boxes without
// such a counterpart are counted in `rejected`.
std::vector<DetectionRow> Undistorted(std::vector<DetectionRow> rows, const Camera& camera,
                                      const Distortion& distortion, RejectionCounts* rejected);

}  // namespace soslam
