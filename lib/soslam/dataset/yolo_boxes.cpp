// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/yolo_boxes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/dataset/class_names.h"
#include "soslam/dataset/dataset_files.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

constexpr std::array kLists = {"classes.txt", "labels.txt", "train.txt",
                               "val.txt",     "valid.txt",  "test.txt"};

// True for files that programs or systems add beside labels.
bool IsExtra(const fs::path& path) {
  const std::string name = path.filename().string();
  const auto is_of_macos = [](const fs::path& part) { return part == "__MACOSX"; };
  return name.starts_with('.') || name.starts_with("README") || name.starts_with("readme") ||
         std::ranges::any_of(path, is_of_macos);
}

bool IsLabels(const fs::path& path) { return path.extension() == ".txt" && !IsExtra(path); }

// True if a file of this name is a list of something other than boxes.
bool IsList(const fs::path& path, const std::vector<TextLine>& lines) {
  if (std::ranges::find(kLists, path.filename().string()) == kLists.end()) return false;
  return !lines.empty() && !std::isdigit(static_cast<unsigned char>(lines.front().text.front()));
}

}  // namespace

YoloTexts ReadYoloTexts(const fs::path& path) {
  if (!Exists(path)) {
    throw InputError(path.string() + ": is missing; expected a folder of YOLO text files");
  }
  YoloTexts texts;
  if (IsFolder(path)) {
    for (const fs::path& file : FolderEntries(path)) {
      if (!IsLabels(file.filename())) continue;
      auto lines = ReadTextLines(file);
      if (!IsList(file, lines)) texts.images.push_back({file.stem().string(), std::move(lines)});
    }
  } else {
    const auto is_wanted = [](const fs::path& name) {
      return IsLabels(name) || (IsLabelFile(name) && !IsExtra(name));
    };
    for (const ArchivedText& entry : ReadTextArchive(path, is_wanted)) {
      const std::string place = fmt::format("{}/{}", path.string(), entry.name);
      if (IsLabels(entry.name)) {
        auto lines = TextLines(entry.text, place);
        if (!IsList(entry.name, lines)) {
          texts.images.push_back({fs::path(entry.name).stem().string(), std::move(lines)});
          continue;
        }
      }
      if (IsLabelFile(entry.name))
        texts.names.push_back(FindLabels(place, [&] { return entry.text; }));
    }
  }
  if (texts.images.empty()) {
    std::vector<std::string> folders;
    for (const fs::path& entry : IsFolder(path) ? FolderEntries(path) : std::vector<fs::path>()) {
      if (IsFolder(entry)) folders.push_back(entry.filename().string());
    }
    throw InputError(fmt::format(
        "{}: has no *.txt; expected one for each image{}", path.string(),
        folders.empty() ? ""
                        : ", directly in this folder; it has folders: " + NamesInWords(folders)));
  }
  std::set<std::string> images;
  for (const YoloText& text : texts.images) {
    if (images.insert(text.image).second) continue;
    throw InputError(fmt::format("{}: has several files {}.txt; expected one for each image",
                                 path.string(), text.image));
  }
  return texts;
}

namespace {

using Rows = std::vector<YoloRow*>;

bool IsScore(double value) { return value >= 0.0 && value <= 1.0; }

bool IsTrack(double value) {
  return value >= -1.0 && value <= std::numeric_limits<int>::max() && value == std::floor(value);
}

// The first row whose extra violates `is_it`; null when there is none.
const YoloRow* FirstOther(const Rows& rows, size_t extra, bool (*is_it)(double)) {
  const auto found =
      std::ranges::find_if(rows, [&](const YoloRow* row) { return !is_it(row->extras[extra]); });
  return found == rows.end() ? nullptr : *found;
}

void SetScores(const Rows& rows, size_t extra) {
  for (YoloRow* row : rows) row->box.score = row->extras[extra];
}

void SetTracks(const Rows& rows, size_t extra) {
  for (YoloRow* row : rows) row->box.object_id = static_cast<int>(row->extras[extra]);
}

[[noreturn]] void Refuse(const YoloRow& row, const std::string& what) {
  throw InputError(fmt::format("{}: {}", row.box.place, what));
}

void ReadPairs(const Rows& rows) {
  const YoloRow* other = nullptr;
  for (const auto& [score, track] : {std::pair<size_t, size_t>{0, 1}, {1, 0}}) {
    const YoloRow* no_score = FirstOther(rows, score, &IsScore);
    const YoloRow* no_track = FirstOther(rows, track, &IsTrack);
    if (no_score == nullptr && no_track == nullptr) {
      SetScores(rows, score);
      SetTracks(rows, track);
      return;
    }
    if (other == nullptr) other = no_score != nullptr ? no_score : no_track;
  }
  Refuse(*other, fmt::format("has 7 numbers that end with {} {}; expected a confidence from 0 to 1 "
                             "and the integer of a track, in one order in all files (polygons of "
                             "segmentation labels are not read: save boxes)",
                             other->extras[0], other->extras[1]));
}

void ReadSingles(const Rows& rows, bool are_beside_pairs) {
  const YoloRow* no_score = FirstOther(rows, 0, &IsScore);
  if (no_score == nullptr) return SetScores(rows, 0);
  const YoloRow* no_track = FirstOther(rows, 0, &IsTrack);
  if (are_beside_pairs || no_track != nullptr) {
    Refuse(*no_score, fmt::format("has the sixth number {}; expected a confidence from 0 to 1{}",
                                  no_score->extras[0],
                                  are_beside_pairs ? ", as others have beside a track"
                                                   : ", or integers of tracks in all files"));
  }
  std::set<std::pair<FrameKey, double>> seen;
  for (const YoloRow* row : rows) {
    const double track = row->extras[0];
    if (track <= 0.0 || seen.emplace(row->box.frame, track).second) continue;
    Refuse(*row, fmt::format("has the sixth number {} twice in one image; expected a confidence "
                             "from 0 to 1, or the integer of a track, which no image has twice",
                             track));
  }
  SetTracks(rows, 0);
}

constexpr double kRounding = 1e-3;  // files round to three digits at least
// Largest overhang of boxes by annotators and detectors, fraction.
constexpr double kMostBeyond = 0.05;

// Box with corners in fractions of the image.
Box FractionsBox(const std::array<double, 4>& values, const std::string& place) {
  for (size_t i = 0; i < values.size(); ++i) {
    const double least = i < 2 ? -kMostBeyond : -kRounding;
    if (values[i] >= least && values[i] <= 1.0 + kMostBeyond) continue;
    throw InputError(
        fmt::format("{}: has {}; expected fractions of the image's width and height, 0 to 1", place,
                    values[i]));
  }
  const auto [cx, cy, w, h] = values;
  return {cx - 0.5 * w, cy - 0.5 * h, cx + 0.5 * w, cy + 0.5 * h};
}

Box PixelBox(const std::array<double, 4>& values, const std::string& place) {
  const auto [x, y, w, h] = values;
  if (std::max({x, y, w, h}) <= 1.0) {
    throw InputError(
        fmt::format("{}: all of {} are at most 1; expected pixels", place, fmt::join(values, " ")));
  }
  if (w < 0.0 || h < 0.0) {
    throw InputError(fmt::format("{}: size is {} x {}; expected pixels, not below 0", place, w, h));
  }
  return FromCornerOrigin({x, y, x + w, y + h});
}

}  // namespace

void ReadYoloExtras(std::vector<YoloRow>* rows) {
  Rows singles, pairs;
  for (YoloRow& row : *rows) {
    if (row.extras.size() == 1) singles.push_back(&row);
    if (row.extras.size() == 2) pairs.push_back(&row);
  }
  if (!pairs.empty()) ReadPairs(pairs);
  if (!singles.empty()) ReadSingles(singles, !pairs.empty());
}

namespace {

// A box from four numbers by a convention. Throws InputError naming `place`.
using ToBox = std::function<Box(const std::array<double, 4>&, const std::string& place)>;

std::vector<LabelledBox> ReadBoxes(const YoloTexts& texts, const std::vector<std::string>& labels,
                                   const std::array<const char*, 4>& names, const ToBox& to_box) {
  std::vector<YoloRow> rows;
  for (const YoloText& text : texts.images) {
    for (const TextLine& line : text.lines) {
      const auto words = SplitWords(line.text);
      if (words.size() < 5 || words.size() > 7) {
        throw InputError(fmt::format("{}: has {} numbers; expected class {} [score] [track]{}",
                                     line.place, words.size(), fmt::join(names, " "),
                                     words.size() > 7
                                         ? ": labels of segmentation (polygons), poses "
                                           "and oriented boxes are not read, save boxes"
                                         : ""));
      }
      const int index = ParseInteger(words[0], line.place, "class");
      if (index < 0 || index >= static_cast<int>(labels.size())) {
        throw InputError(fmt::format("{}: class is {}; expected 0 to {}, one of {} labels",
                                     line.place, index, labels.size() - 1, labels.size()));
      }
      const auto numbers = ParseReals(std::span(words).subspan(1), line.place, names);
      const Box box = to_box(numbers, line.place);
      YoloRow& row =
          rows.emplace_back(YoloRow{{line.place, text.image, labels[index], 1.0, box}, {}});
      for (size_t i = 5; i < words.size(); ++i) {
        row.extras.push_back(ParseReal(words[i], line.place, fmt::format("number {}", i + 1)));
      }
    }
  }
  ReadYoloExtras(&rows);
  std::vector<LabelledBox> boxes;
  for (YoloRow& row : rows) boxes.push_back(std::move(row.box));
  return boxes;
}

}  // namespace

std::vector<LabelledBox> ReadNormalisedYoloBoxes(const YoloTexts& texts,
                                                 const std::vector<std::string>& labels,
                                                 int image_width, int image_height,
                                                 RejectionCounts* corrected) {
  const auto to_box = [&](const std::array<double, 4>& numbers, const std::string& place) {
    Box box = FractionsBox(numbers, place);
    const double beyond = std::max({0.0, -box.x_min, -box.y_min, box.x_max - 1.0, box.y_max - 1.0});
    if (beyond <= kMostBeyond) {
      box = {std::max(box.x_min, 0.0), std::max(box.y_min, 0.0), std::min(box.x_max, 1.0),
             std::min(box.y_max, 1.0)};
    }
    if (beyond > kRounding && beyond <= kMostBeyond) ++(*corrected)["cut_to_image"];
    return FromCornerOrigin({box.x_min * image_width, box.y_min * image_height,
                             box.x_max * image_width, box.y_max * image_height});
  };
  return ReadBoxes(texts, labels, {"cx", "cy", "w", "h"}, to_box);
}

std::vector<LabelledBox> ReadPixelYoloBoxes(const YoloTexts& texts,
                                            const std::vector<std::string>& labels) {
  return ReadBoxes(texts, labels, {"x", "y", "w", "h"}, &PixelBox);
}

}  // namespace soslam
