// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "dataset/gate.h"
#include "dataset/labelled_box.h"
#include "dataset/yolo_texts.h"

namespace soslam {

// Detections as YOLO programs write them: one text file per image, named like the image, one line
// per box. Which of the two conventions holds cannot be told from the numbers with certainty, so
// each has its reader; a line that is plainly of the other one is refused. The boxes come file by
// file, sorted by name; an image without detections may have an empty file or none. What may follow
// the box, its score and its track, ReadYoloExtras finds out; tracks become object ids.
//
// `labels` are the names of the classes, from 0. Both throw InputError naming the line.

// Lines "class cx cy w h [score] [track]": centre and size in fractions of the image's width and
// height. This is what YOLOv5 and its successors save, and the format of their labels. Boxes that
// reach beyond the image by less than a twentieth of it are cut to it; when by more than rounding,
// they are counted in `mended` as cut_to_image.
std::vector<LabelledBox> ReadNormalisedYoloBoxes(const YoloTexts& texts,
                                                 const std::vector<std::string>& labels,
                                                 int image_width, int image_height,
                                                 RejectionCounts* mended);

// Lines "class x y w h [score] [track]": upper left corner and size in pixels, as EAO-SLAM reads
// them.
std::vector<LabelledBox> ReadPixelYoloBoxes(const YoloTexts& texts,
                                            const std::vector<std::string>& labels);

}  // namespace soslam
