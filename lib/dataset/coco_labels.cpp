// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/coco_labels.h"

#include <algorithm>
#include <array>

namespace soslam {
namespace {

// Ids of dropped categories below 90; 91 was dropped, too.
constexpr std::array kUnusedIds = {12, 26, 29, 30, 45, 66, 68, 69, 71, 83};

}  // namespace

const std::vector<std::string>& CocoLabels() {
  static const std::vector<std::string> labels = {"person",        "bicycle",      "car",
                                                  "motorcycle",    "airplane",     "bus",
                                                  "train",         "truck",        "boat",
                                                  "traffic light", "fire hydrant", "stop sign",
                                                  "parking meter", "bench",        "bird",
                                                  "cat",           "dog",          "horse",
                                                  "sheep",         "cow",          "elephant",
                                                  "bear",          "zebra",        "giraffe",
                                                  "backpack",      "umbrella",     "handbag",
                                                  "tie",           "suitcase",     "frisbee",
                                                  "skis",          "snowboard",    "sports ball",
                                                  "kite",          "baseball bat", "baseball glove",
                                                  "skateboard",    "surfboard",    "tennis racket",
                                                  "bottle",        "wine glass",   "cup",
                                                  "fork",          "knife",        "spoon",
                                                  "bowl",          "banana",       "apple",
                                                  "sandwich",      "orange",       "broccoli",
                                                  "carrot",        "hot dog",      "pizza",
                                                  "donut",         "cake",         "chair",
                                                  "couch",         "potted plant", "bed",
                                                  "dining table",  "toilet",       "tv",
                                                  "laptop",        "mouse",        "remote",
                                                  "keyboard",      "cell phone",   "microwave",
                                                  "oven",          "toaster",      "sink",
                                                  "refrigerator",  "book",         "clock",
                                                  "vase",          "scissors",     "teddy bear",
                                                  "hair drier",    "toothbrush"};
  return labels;
}

std::optional<int> CocoClassIndex(int category_id) {
  constexpr int kLastId = 90;
  if (category_id < 1 || category_id > kLastId) return std::nullopt;
  const auto unused_from = std::lower_bound(kUnusedIds.begin(), kUnusedIds.end(), category_id);
  if (unused_from != kUnusedIds.end() && *unused_from == category_id) return std::nullopt;
  return category_id - 1 - static_cast<int>(unused_from - kUnusedIds.begin());
}

int CocoCategoryId(int class_index) {
  int category_id = class_index + 1;
  for (const int unused_id : kUnusedIds) {
    if (category_id >= unused_id) ++category_id;
  }
  return category_id;
}

}  // namespace soslam
