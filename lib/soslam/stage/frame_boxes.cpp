// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "soslam/base/error.h"
#include "soslam/base/text.h"
#include "soslam/dataset/labelled_box.h"
#include "soslam/dataset/photo_folder.h"
#include "soslam/image/image_format.h"
#include "soslam/stage/choose_frames.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Coordinate of a pixel after scaling; both count from the centre of the first pixel.
double Scaled(double coordinate, double scale) { return (coordinate + 0.5) * scale - 0.5; }

// The images that detectors number, in the order of their names: the row of each among the chosen
// ones, or none.
std::vector<std::optional<int>> RowsOfImages(const std::vector<SourceFrame>& frames) {
  using NameAndRow = std::pair<std::pair<std::string, std::string>, std::optional<int>>;
  std::vector<NameAndRow> named;
  int row = 0;
  for (const SourceFrame& frame : frames) {
    if (HasNameOfRawPhoto(frame.source)) continue;  // detectors read the JPEGs beside them
    named.emplace_back(OrderOfName(frame.source),
                       IsLeftOut(frame) ? std::nullopt : std::optional(row++));
  }
  // All frames of a video have one name.
  std::ranges::stable_sort(named, {}, &NameAndRow::first);
  std::vector<std::optional<int>> rows;
  for (const auto& [name, row_of_image] : named) rows.push_back(row_of_image);
  return rows;
}

// Throws InputError for a file of soslam-detect, which lists its images, of more or fewer images.
void CheckCountOfImages(const fs::path& path, size_t expected) {
  std::ifstream stream(path);
  size_t images = 0;
  for (std::string line; std::getline(stream, line) && line.starts_with('#');) {
    if (line.starts_with("# input ")) ++images;
  }
  if (images > 0 && images != expected) {
    throw InputError(
        fmt::format("{}: is of {} images; expected boxes of all {} photos or video frames: were "
                    "they detected in "
                    "images that soslam-frames had chosen? Give the network instead",
                    path.string(), images, expected));
  }
}

}  // namespace

std::string FrameBoxesText(const fs::path& path, const ChosenFrames& chosen) {
  const std::vector<std::optional<int>> rows = RowsOfImages(chosen.record.frames);
  const double scale_x = static_cast<double>(chosen.record.width) / chosen.source_size.width;
  const double scale_y = static_cast<double>(chosen.record.height) / chosen.source_size.height;
  CheckCountOfImages(path, rows.size());
  const std::vector<LabelledBox> boxes = ReadDetectionsCsv(path);
  std::vector<LabelledBox> of_chosen;
  int left_out = 0, unknown = 0;
  for (LabelledBox box : boxes) {
    const int number = std::get<int>(box.frame);
    const bool is_known = number >= 0 && number < std::ssize(rows);
    if (!is_known || !rows[number]) {
      ++(is_known ? left_out : unknown);
      continue;
    }
    box.frame = *rows[number];
    box.box = {Scaled(box.box.x_min, scale_x), Scaled(box.box.y_min, scale_y),
               Scaled(box.box.x_max, scale_x), Scaled(box.box.y_max, scale_y)};
    of_chosen.push_back(std::move(box));
  }
  if (unknown > 0 && rows.size() < chosen.record.frames.size()) {
    throw InputError(fmt::format(
        "{}: has boxes of images beyond the {} that are no RAW photos; expected `frame` to count "
        "these alone: move the {} RAW photos elsewhere, or count without them",
        path.string(), rows.size(), chosen.record.frames.size() - rows.size()));
  }
  if (of_chosen.empty()) {
    throw InputError(fmt::format(
        "{}: none of its {} boxes is of a chosen image; expected as `frame` the number of the "
        "image, from 0, in the order of their names or of the video",
        path.string(), boxes.size()));
  }
  fmt::print("{}: {} boxes of chosen images, {} of images that were left out, {} of others\n",
             path.filename().string(), of_chosen.size(), left_out, unknown);
  std::ranges::stable_sort(of_chosen, {},
                           [](const LabelledBox& box) { return std::get<int>(box.frame); });
  return fmt::format("# Written by soslam-frames from {}\n{}", OneLine(path.filename().string()),
                     LabelledBoxesText(of_chosen));
}

}  // namespace soslam
