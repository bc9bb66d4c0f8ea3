// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"
#include "model/image_orientation.h"

namespace soslam {

// Layout of a YOLO network's output. N candidates, C classes; centre, width and height are in
// pixels of the network's input.
enum class YoloLayout {
  kV5,     // [1, N, 5 + C]: cx cy w h, objectness, a score of each class. Also YOLOv7.
  kV8,     // [1, 4 + C, N]: transposed, without objectness. Also YOLO11.
  kYolox,  // as kV5, but cx cy in cells and w h as logarithms of cells: YOLOX as published.
};
inline constexpr const char* kYoloLayoutNames[] = {"v5", "v8", "yolox"};

// Pixel values that a network expects.
enum class PixelValues {
  kRgbUnit,  // red, green, blue from 0 to 1: Ultralytics' networks
  kBgrByte,  // blue, green, red from 0 to 255: YOLOX
};
inline constexpr const char* kPixelValuesNames[] = {"rgb_0_1", "bgr_0_255"};

struct DetectorOptions {
  YoloLayout output_layout = YoloLayout::kV5;
  PixelValues pixel_values = PixelValues::kRgbUnit;
  int input_width = 640;
  int input_height = 640;
  ImageOrientation image_orientation = ImageOrientation::kUpright;
  double min_score = 0.25;
  double max_overlap = 0.45;

  void Describe(OptionVisitor& visit) {
    visit.Group("Network");
    visit.Choice(
        "output_layout", &output_layout, kYoloLayoutNames,
        "the network's output: v5 [1, N, 5 + classes], v8 [1, 4 + classes, N], or yolox: v5 "
        "with boxes in cells of its grids, as YOLOX is published (exported with "
        "--decode_in_inference it is v5)");
    visit.Choice("pixel_values", &pixel_values, kPixelValuesNames,
                 "what the network takes: rgb_0_1 (Ultralytics) or bgr_0_255 (YOLOX)");
    visit.Integer("input_width_px", &input_width, {1, 8192},
                  "width of the network's input, as it was exported");
    visit.Integer("input_height_px", &input_height, {1, 8192},
                  "height of the network's input, as it was exported");
    visit.Group("Images");
    visit.Choice("image_orientation", &image_orientation, kImageOrientationNames,
                 "where EXIF turns images: what is detected, and what boxes refer to, is the image "
                 "as viewers show it, or the pixels as the file stores them");
    visit.Group("Detections that are kept");
    visit.Real("min_score", &min_score, {0, 1}, "detections with a lower score are dropped");
    visit.Real("max_overlap", &max_overlap, {0, 1},
               "of two boxes of one class with a larger IoU, the one with the lower score is "
               "dropped");
  }
};

}  // namespace soslam
