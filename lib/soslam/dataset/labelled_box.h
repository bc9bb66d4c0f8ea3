// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "soslam/dataset/gate.h"
#include "soslam/geometry/box.h"
#include "soslam/image/image_format.h"

namespace soslam {

// Reference of a box to its image, as in the file: the 0-based row of the image list, or a file
// name with or without its folder and extension. FrameLookup finds the image.
using FrameKey = std::variant<int, std::string>;

// A detection in an external file.
struct LabelledBox {
  std::string place;  // "<file>:<line>" or "<file>#<JSON pointer>", for error messages
  FrameKey frame;
  std::string label;
  double score;  // 1 where the file has none
  Box box;
  // Object id, where the file has one.
  std::optional<int> object_id = std::nullopt;
  // Size of its image, where the file states it.
  std::optional<ImageSize> image_size = std::nullopt;
  // The turned box that `box` is the upright one around, where the file has that.
  std::optional<TurnedBox> as_drawn = std::nullopt;
};

// Conversion of the pixel origin: detectors and annotation tools measure from the outer corner of
// the top-left pixel, this project from that pixel's centre, half a pixel further in.
inline Box FromCornerOrigin(const Box& box) {
  return {box.x_min - 0.5, box.y_min - 0.5, box.x_max - 0.5, box.y_max - 0.5};
}
inline Box ToCornerOrigin(const Box& box) {
  return {box.x_min + 0.5, box.y_min + 0.5, box.x_max + 0.5, box.y_max + 0.5};
}

// Reads detections.csv, a table (ForEachCsvRow) with the columns frame, object_id, label, score,
// x1, y1, x2, y2. Frames are rows of rgb.txt.
//
// The columns object_id and score may be absent, and fields of object_id may be empty. Throws
// InputError naming the line, and for a file without header, for boxes with an angle, and for these
// two columns under another usual name.
std::vector<LabelledBox> ReadDetectionsCsv(const std::filesystem::path& path);

// CSV text of a table without object ids, pixels with two decimals, scores with four. The frames
// must be rows of rgb.txt, the labels without comma.
std::string LabelledBoxesText(const std::vector<LabelledBox>& boxes);

// Boxes and the class names that their labels were taken from; no names where boxes have labels.
struct FolderBoxes {
  std::vector<LabelledBox> boxes;
  std::vector<std::string> class_names = {};
  RejectionCounts corrected = {};  // boxes that were changed on reading
  RejectionCounts left_out = {};   // boxes that are not of one object in an image
  std::vector<Finding> findings = {};
};

// Reads detections in COCO's results format: [{"image_id", "category_id", "bbox": [x, y, w, h],
// "score"}], pixels from the image's outer corner; or a COCO data set with such boxes as
// "annotations". A missing "score" is 1. A "track_id" of an entry, or of its "attributes", is the
// object id. Null is as good as missing, and attributes may have their numbers as text.
//
// Left out are regions of crowds ("iscrowd" or "ignore" is 1), and boxes of objects that left the
// image (CVAT's attribute "outside"). A box with CVAT's attribute "rotation" (degrees, about its
// centre) becomes the upright box around it: the same object's after quarter turns, a larger one
// after others. Angles in other places are refused.
//
// `dataset`, when given, is the JSON file that the results belong to: its "images" ({"id",
// "file_name"}) and "categories" ({"id", "name"}) define the ids; a data set with boxes contains
// them itself, or some of them. Without either, an integer image_id is a 0-based row of the image
// list, and category_id is COCO's own (1 to 90). A text as image_id is the name of an image. In
// file order. Throws InputError with file and JSON pointer.
FolderBoxes ReadCocoResults(const std::filesystem::path& results,
                            const std::optional<std::filesystem::path>& dataset = std::nullopt);

// Reads detections in OA-SLAM's format (M. Zins, G. Simon, M.-O. Berger, "OA-SLAM", ISMAR 2022):
// [{"file_name", "detections": [{"category_id", "detection_score", "bbox": [x1, y1, x2, y2]}]}],
// pixels from the image's outer corner. A missing score is 1. `labels` are the names of the
// categories, from 0; OA-SLAM's own files use COCO's 80. In file order. Throws InputError with file
// and JSON pointer.
std::vector<LabelledBox> ReadOaSlamBoxes(const std::filesystem::path& path,
                                         const std::vector<std::string>& labels);

}  // namespace soslam
