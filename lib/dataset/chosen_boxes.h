// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "dataset/labelled_box.h"

namespace soslam {

struct ChosenBoxes {
  std::vector<LabelledBox> boxes;  // of rows of the new list, in its order, without object ids
  int left_out = 0;                // number of boxes of images that were left out
  int unknown = 0;                 // number of boxes of images that do not exist
};

// The boxes of the chosen images, for images that were scaled by `scale_x` and `scale_y`. The boxes
// refer to images by their number among all, from 0; `chosen_rows` has the row of each in the new
// list, none if it was left out.
ChosenBoxes BoxesOfChosen(const std::vector<LabelledBox>& boxes,
                          const std::vector<std::optional<int>>& chosen_rows, double scale_x,
                          double scale_y);

}  // namespace soslam
