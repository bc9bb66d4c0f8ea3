// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "dataset/gate.h"
#include "dataset/labelled_box.h"
#include "dataset/yolo_texts.h"

namespace soslam {

// Readers of detections written by YOLO programs: one text file per image, named like the image,
// one line per box. The two conventions cannot be distinguished with certainty from the numbers, so
// each has its own reader; a line that is clearly of the other one is refused. Boxes are ordered by
// file name; an image without detections may have an empty file or none. ReadYoloExtras interprets
// score and track after the box; tracks become object ids.
//
// `labels` are the names of the classes, from 0. Both throw InputError naming the line.

// Reads lines "class cx cy w h [score] [track]": centre and size in fractions of the image's width
// and height, the format of labels and results of YOLOv5 and its successors. Boxes that extend
// beyond the image by less than a twentieth of it are cut to it; if by more than rounding, they are
// counted in `corrected` as cut_to_image.
std::vector<LabelledBox> ReadNormalisedYoloBoxes(const YoloTexts& texts,
                                                 const std::vector<std::string>& labels,
                                                 int image_width, int image_height,
                                                 RejectionCounts* corrected);

// Reads lines "class x y w h [score] [track]": upper left corner and size in pixels, as EAO-SLAM
// does.
std::vector<LabelledBox> ReadPixelYoloBoxes(const YoloTexts& texts,
                                            const std::vector<std::string>& labels);

}  // namespace soslam
