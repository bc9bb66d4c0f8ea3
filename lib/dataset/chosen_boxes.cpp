// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/chosen_boxes.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace soslam {
namespace {

// Coordinate of a pixel after scaling; both count from the centre of the first pixel.
double Scaled(double coordinate, double scale) { return (coordinate + 0.5) * scale - 0.5; }

}  // namespace

ChosenBoxes BoxesOfChosen(const std::vector<LabelledBox>& boxes,
                          const std::vector<std::optional<int>>& chosen_rows, double scale_x,
                          double scale_y) {
  ChosenBoxes chosen;
  for (LabelledBox box : boxes) {
    const int number = std::get<int>(box.frame);
    const bool is_known = number >= 0 && number < std::ssize(chosen_rows);
    const auto row = is_known ? chosen_rows[static_cast<size_t>(number)] : std::nullopt;
    if (!row) {
      ++(is_known ? chosen.left_out : chosen.unknown);
      continue;
    }
    box.frame = *row;
    box.box = {Scaled(box.box.x_min, scale_x), Scaled(box.box.y_min, scale_y),
               Scaled(box.box.x_max, scale_x), Scaled(box.box.y_max, scale_y)};
    box.object_id.reset();
    chosen.boxes.push_back(std::move(box));
  }
  std::ranges::stable_sort(chosen.boxes, {},
                           [](const LabelledBox& box) { return std::get<int>(box.frame); });
  return chosen;
}

}  // namespace soslam
