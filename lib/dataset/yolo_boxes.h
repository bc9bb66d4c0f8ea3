// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dataset/labelled_box.h"

namespace soslam {

// Detections as YOLO programs write them: a folder, or an archive (ReadTextArchive), with one text
// file per image, named like the image, one line per box. Which of the two conventions holds cannot
// be told from the numbers with certainty, so each has its reader; a line that is plainly of the
// other one is refused. The boxes come file by file, sorted by name; an image without detections
// may have an empty file or none.
//
// `labels` are the names of the classes, from 0. Both throw InputError naming the line; also for a
// folder or archive without *.txt.

// Lines "class cx cy w h [score]": centre and size in fractions of the image's width and height.
// This is what YOLOv5 and its successors save, and the format of their labels.
std::vector<LabelledBox> ReadNormalisedYoloBoxes(const std::filesystem::path& path,
                                                 const std::vector<std::string>& labels,
                                                 int image_width, int image_height);

// Lines "class x y w h [score]": upper left corner and size in pixels, as EAO-SLAM reads them.
std::vector<LabelledBox> ReadPixelYoloBoxes(const std::filesystem::path& path,
                                            const std::vector<std::string>& labels);

}  // namespace soslam
