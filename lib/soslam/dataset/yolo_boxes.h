// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "soslam/dataset/class_names.h"
#include "soslam/dataset/gate.h"
#include "soslam/dataset/labelled_box.h"
#include "soslam/dataset/text_file.h"

namespace soslam {

// The boxes of one image, one per line.
struct YoloText {
  std::string image;  // its name without extension
  std::vector<TextLine> lines;
};

// Content of a folder or an archive of YOLO's labels.
struct YoloTexts {
  std::vector<YoloText> images;   // sorted by name
  std::vector<ClassNames> names;  // lists of class names in an archive
};

// Reads the *.txt of a folder, or of an archive (ReadTextArchive) at any depth. Skipped are hidden
// files (of macOS), __MACOSX, README*, and the lists classes.txt, labels.txt, train.txt, val.txt,
// valid.txt and test.txt of CVAT and others unless they begin with a number, as boxes do. Throws
// InputError when there is nothing to read, and for two files of one name.
YoloTexts ReadYoloTexts(const std::filesystem::path& path);

// A line of YOLO's labels.
struct YoloRow {
  LabelledBox box;
  std::vector<double> extras;  // values after the box: none, one or two
};

// Determines from all rows together which of the extras are confidences and which tracks, as tools
// write both in either order, and fills `score` and `object_id`. Confidences are in [0, 1]; tracks
// are integers from -1 (none).
//
//   one extra   confidences if all values allow it (also if all are 1), otherwise tracks, each
//               at most once per image; only confidences if other rows have two extras
//   two extras  confidence and track, as written by Ultralytics, if all values allow it,
//               otherwise track and confidence
//
// Throws InputError, naming a row, in all other cases.
void ReadYoloExtras(std::vector<YoloRow>* rows);

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
