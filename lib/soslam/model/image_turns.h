// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "soslam/base/description.h"

namespace soslam {

inline constexpr size_t kQuarterTurns = 4;

// Detections in images and in turned copies of them: most are found where images are upright.
struct ImageTurns {
  struct Row {
    std::string image;  // path in the dataset folder
    // Sums of the scores of all detections in the image turned clockwise by 0, 90, 180, 270
    // degrees.
    std::array<double, kQuarterTurns> scores = {};
  };
  int upright_turn_deg = 0;  // clockwise, in which detections.csv was found
  double probability = 1.0;  // that this turn makes images upright
  std::vector<Row> images = {};
};
template <typename Visitor>
void Describe(Visitor& visit, ImageTurns::Row& row) {
  visit.Field("image", &row.image, "path in the dataset folder");
  visit.Field(
      "scores", &row.scores,
      "sums over all detections in the image turned clockwise by 0, 90, 180 and 270 degrees",
      kNotNegative);
}
template <typename Visitor>
void Describe(Visitor& visit, ImageTurns& turns) {
  visit.Field("upright_turn_deg", &turns.upright_turn_deg,
              "clockwise turn of all images in which the detections were found; 0, 90, 180, 270",
              {0.0, 270.0});
  visit.Field("probability", &turns.probability, "that this turn makes images upright", kShare);
  visit.Field("images", &turns.images, "some images, spread over all", {.least_items = 1});
}

}  // namespace soslam
