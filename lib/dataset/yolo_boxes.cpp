// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/yolo_boxes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/file_kind.h"
#include "dataset/text_archive.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// One line: what its numbers mean is up to the reader.
struct YoloLine {
  std::string label;
  std::array<double, 4> values;
  double score;
};

YoloLine ParseLine(const TextLine& line, const std::array<const char*, 4>& names,
                   const std::vector<std::string>& labels) {
  const auto words = SplitWords(line.text);
  if (words.size() != 5 && words.size() != 6) {
    throw InputError(fmt::format("{}: has {} numbers; expected class {} [score]", line.place,
                                 words.size(), fmt::join(names, " ")));
  }
  const int index = ParseInteger(words[0], line.place, "class");
  if (index < 0 || index >= static_cast<int>(labels.size())) {
    throw InputError(fmt::format("{}: class is {}; expected 0 to {}, one of {} labels", line.place,
                                 index, labels.size() - 1, labels.size()));
  }
  YoloLine parsed{labels[static_cast<size_t>(index)], {}, 1.0};
  for (size_t i = 0; i < names.size(); ++i) {
    parsed.values[i] = ParseReal(words[i + 1], line.place, names[i]);
  }
  if (words.size() == 6) parsed.score = ParseReal(words[5], line.place, "score");
  return parsed;
}

Box NormalisedBox(const std::array<double, 4>& values, const std::string& place, int width,
                  int height) {
  constexpr double kRounding = 1e-3;  // files round to three digits at least
  for (const double value : values) {
    if (value < -kRounding || value > 1.0 + kRounding) {
      throw InputError(fmt::format(
          "{}: has {}; expected fractions of the image's width and height, 0 to 1", place, value));
    }
  }
  const auto [cx, cy, w, h] = values;
  return FromCornerOrigin({(cx - 0.5 * w) * width, (cy - 0.5 * h) * height, (cx + 0.5 * w) * width,
                           (cy + 0.5 * h) * height});
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

// The boxes of one image.
struct ImageText {
  std::string image;  // its name without extension
  std::vector<TextLine> lines;
};

std::vector<ImageText> ReadFolder(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".txt") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<ImageText> texts;
  for (const fs::path& file : files) texts.push_back({file.stem().string(), ReadTextLines(file)});
  return texts;
}

std::vector<ImageText> ReadArchive(const fs::path& archive) {
  std::vector<ImageText> texts;
  for (const ArchivedText& entry : ReadTextArchive(archive, ".txt")) {
    std::istringstream text(entry.text);
    texts.push_back({fs::path(entry.name).stem().string(),
                     TextLines(text, fmt::format("{}/{}", archive.string(), entry.name))});
  }
  return texts;
}

std::vector<ImageText> ReadTexts(const fs::path& path) {
  if (!Exists(path)) {
    throw InputError(path.string() + ": is missing; expected a folder of YOLO text files");
  }
  std::vector<ImageText> texts = IsFolder(path) ? ReadFolder(path) : ReadArchive(path);
  if (texts.empty()) {
    throw InputError(path.string() + ": has no *.txt; expected one for each image");
  }
  std::set<std::string> images;
  for (const ImageText& text : texts) {
    if (images.insert(text.image).second) continue;
    throw InputError(fmt::format("{}: has several files {}.txt; expected one for each image",
                                 path.string(), text.image));
  }
  return texts;
}

template <typename MakeBox>
std::vector<LabelledBox> ReadBoxes(const fs::path& path, const std::vector<std::string>& labels,
                                   const std::array<const char*, 4>& names,
                                   const MakeBox& make_box) {
  std::vector<LabelledBox> boxes;
  for (const ImageText& image : ReadTexts(path)) {
    for (const TextLine& line : image.lines) {
      const YoloLine parsed = ParseLine(line, names, labels);
      boxes.push_back({line.place, image.image, parsed.label, parsed.score,
                       make_box(parsed.values, line.place)});
    }
  }
  return boxes;
}

}  // namespace

std::vector<LabelledBox> ReadNormalisedYoloBoxes(const fs::path& path,
                                                 const std::vector<std::string>& labels,
                                                 int image_width, int image_height) {
  return ReadBoxes(path, labels, {"cx", "cy", "w", "h"},
                   [&](const std::array<double, 4>& values, const std::string& place) {
                     return NormalisedBox(values, place, image_width, image_height);
                   });
}

std::vector<LabelledBox> ReadPixelYoloBoxes(const fs::path& path,
                                            const std::vector<std::string>& labels) {
  return ReadBoxes(path, labels, {"x", "y", "w", "h"}, &PixelBox);
}

}  // namespace soslam
