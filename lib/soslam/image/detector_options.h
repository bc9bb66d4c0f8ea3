// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "soslam/base/options.h"
#include "soslam/image/network.h"
#include "soslam/image/network_output.h"

namespace soslam {

// The images that boxes refer to, where EXIF turns them; kSurer: those in which the network is
// surer.
enum class BoxOrientation { kUpright, kStored, kSurer };
inline constexpr const char* kBoxOrientationNames[] = {"upright", "stored", "surer"};

struct DetectorOptions {
  NetworkBackend backend = NetworkBackend::kOpenCv;
  OutputLayout output_layout = OutputLayout::kAuto;
  PixelValues pixel_values = PixelValues::kAuto;
  int input_width = 0;  // 0 for automatic, as the height
  int input_height = 0;
  BoxOrientation image_orientation = BoxOrientation::kUpright;
  std::string rename_labels;
  std::string keep_labels;
  double min_score = 0.25;
  double max_overlap = 0.45;
  bool class_agnostic = false;
  std::string interchangeable_labels;

  void Describe(OptionVisitor& visit) {
    visit.Group("Network");
    visit.Choice("backend", &backend, kNetworkBackendNames,
                 "what runs the network; onnxruntime also runs transformers, and is there if the "
                 "software was built with it");
    visit.Choice("output_layout", &output_layout, kOutputLayoutNames,
                 "the network's outputs: v5 [1, N, 5 + classes], v8 [1, 4 + classes, N], yolox (v5 "
                 "with boxes in cells of its grids, as YOLOX is published), end_to_end [1, N, 6]; "
                 "detr (logits and boxes), detr_softmax (the last logit is that of no object), "
                 "detr_boxes (labels, boxes, scores: RT-DETR, D-FINE); paddle (boxes and scores), "
                 "paddle_nms [N, 6]; auto: as the file and the outputs say");
    visit.Choice(
        "pixel_values", &pixel_values, kPixelValuesNames,
        "what the network takes: rgb_0_1 (Ultralytics, RT-DETR, D-FINE), bgr_0_255 (YOLOX) "
        "or rgb_imagenet (rgb_0_1 with ImageNet's mean and deviation: RF-DETR, DETR, "
        "PicoDet); auto: as the file and the outputs say");
    visit.Integer("input_width_px", &input_width, {0, 8192},
                  "width of the network's input; 0: as it was exported, or the shape of the images "
                  "if a YOLO network takes any");
    visit.Integer("input_height_px", &input_height, {0, 8192},
                  "height of the network's input, likewise");
    visit.Group("Images");
    visit.Choice("image_orientation", &image_orientation, kBoxOrientationNames,
                 "where EXIF turns images, the network sees both the image as viewers show it and "
                 "the pixels as the file stores them, and its boxes are those with the larger sum "
                 "of scores. They refer to the former (upright), to the latter (stored), or to "
                 "those that they were found in, as the first line of the file says (surer)");
    visit.Group("Detections that are kept");
    visit.Text("rename_labels", &rename_labels,
               "other names for the network's labels: 'tv=monitor, couch=sofa'");
    visit.Text("keep_labels", &keep_labels,
               "detections of other labels (after renaming) are dropped; commas between several, "
               "empty: all are kept");
    visit.Real("min_score", &min_score, {0, 1}, "detections with a lower score are dropped");
    visit.Real("max_overlap", &max_overlap, {0, 1},
               "of two boxes of one label with a larger IoU, the one with the lower score is "
               "dropped");
    visit.Text("interchangeable_labels", &interchangeable_labels,
               "labels that count as one for max_overlap, groups of comma-separated labels, "
               "separated by semicolons: 'chair, couch; tv, laptop'");
    visit.Flag("class_agnostic", &class_agnostic, "all labels count as one for max_overlap");
  }
};

}  // namespace soslam
